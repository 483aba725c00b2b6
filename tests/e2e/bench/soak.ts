import { readFileSync } from "node:fs";
import { setTimeout as sleep } from "node:timers/promises";
import { expect, test } from "vitest";
import { endAll, startAll, ViewerPage } from "../browser";

// Measures the memory of a page that shows the breathing thorax, and of its server (npm run soak): PHRENIC_MINUTES is
// the time, 60 by default. The first quarter fills histories and caches, whose sizes are bounded.
const minutes = Number(process.env.PHRENIC_MINUTES ?? 60);
/** Accepted growth from the end of the first quarter to the end. */
const mostGrowth = 0.05;
const samples = 16;

/** Resident memory of a process [MB]. */
function residentOf(pid: number): number {
  const pages = Number(readFileSync(`/proc/${pid}/statm`, "utf8").split(" ")[1]);
  return (pages * 4096) / 1e6;
}

const meanOf = (values: number[]) => values.reduce((sum, each) => sum + each, 0) / values.length;

test(
  "TheMemoryOfPageAndServerIsFlat",
  async () => {
    const [browser, server] = await startAll();
    try {
      const viewer = await ViewerPage.open(browser, server.url, { width: 1280, height: 800 });
      const profiler = await viewer.page.context().newCDPSession(viewer.page);
      const heap: number[] = [];
      const resident: number[] = [];
      for (let i = 0; i <= samples; ++i) {
        if (i > 0) await sleep((minutes * 60_000) / samples);
        await profiler.send("HeapProfiler.collectGarbage");
        const { usedSize } = await profiler.send("Runtime.getHeapUsage");
        heap.push(usedSize / 1e6);
        resident.push(residentOf(server.pid));
        const time = ((i * minutes) / samples).toFixed(1);
        console.log(`${time} min: page ${heap.at(-1)!.toFixed(1)} MB, server ${resident.at(-1)!.toFixed(0)} MB`);
      }
      const quarter = samples / 4;
      for (const values of [heap, resident]) {
        const [before, after] = [values.slice(quarter, quarter + 3), values.slice(-3)].map(meanOf);
        expect(after / before - 1).toBeLessThan(mostGrowth);
      }
    } finally {
      await endAll(browser, server);
    }
  },
  (minutes + 5) * 60_000,
);
