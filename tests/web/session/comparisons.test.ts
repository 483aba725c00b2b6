import { Code, ConnectError } from "@connectrpc/connect";
import { beforeEach, expect, test } from "vitest";
import { Comparisons, type SurfaceFile } from "../../../web/src/session/comparisons";
import { settle } from "../fakes/fake_clock";
import { FakeServer } from "../fakes/fake_server";

let server: FakeServer;
let comparisons: Comparisons;

const text = "v 0 0 0\n";
const fileOf = (name: string, size = text.length): SurfaceFile => ({
  name,
  size,
  arrayBuffer: () => Promise.resolve(new TextEncoder().encode(text).buffer as ArrayBuffer),
});
const vertices = { case: "vertices" as const, value: { distances: [1, 2, NaN] } };
const table = (time: number) => ({
  case: "table" as const,
  value: {
    b: "b.obj",
    stateA: { sessionId: "thorax", body: "diaphragm", tick: 1200n, time },
    rows: [{ distance: { hdMax: 2, meanAToB: 1.5 } }],
    warnings: ["the unit is wrong"],
  },
});
const words = () => (comparisons.progress.value.kind === "failed" ? comparisons.progress.value.message : "");

beforeEach(() => {
  server = new FakeServer();
  server.comparisonEvents = [{ case: "progress", value: 0.5 }, vertices, table(1.2)];
  comparisons = new Comparisons(server.api, "thorax");
  comparisons.choose({ body: "diaphragm" });
});

test("TheCurrentBodyIsComparedWithTheFile", async () => {
  comparisons.choose({ unitMm: 10, time: 0.5 });
  await comparisons.compare(fileOf("b.obj"));
  expect(server.comparisons).toMatchObject([
    {
      a: { source: { case: "body", value: { sessionId: "thorax", body: "diaphragm" } } },
      b: { name: "b.obj", source: { case: "content" }, unitMm: 10, time: 0.5 },
      vertexDistances: true,
    },
  ]);
  expect(new TextDecoder().decode(server.comparisons[0].b!.source.value as Uint8Array)).toBe(text);
  expect(comparisons.progress.value.kind).toBe("idle");
  expect(comparisons.result.value).toMatchObject({
    file: "b.obj",
    body: "diaphragm",
    time: 1.2,
    tick: 1200n,
    distance: { hdMax: 2, meanAToB: 1.5 },
    warnings: ["the unit is wrong"],
    distances: [1, 2, NaN],
  });
});

test("ProgressIsReported", async () => {
  const told: unknown[] = [];
  comparisons.progress.subscribe((work) => told.push(work));
  await comparisons.compare(fileOf("b.obj"));
  expect(told).toContainEqual({ kind: "running", file: "b.obj", done: 0.5 });
});

test("RepeatSendsTheSameFileAndReplacesTheResult", async () => {
  await comparisons.repeat();
  expect(server.comparisons).toEqual([]);
  await comparisons.compare(fileOf("b.obj"));
  server.comparisonEvents = [vertices, table(3.4)];
  await comparisons.repeat();
  expect(server.comparisons[1].b).toEqual(server.comparisons[0].b);
  expect(comparisons.result.value?.time).toBe(3.4);
});

test("ARefusalShowsTheServersMessageAndKeepsTheResult", async () => {
  await comparisons.compare(fileOf("b.obj"));
  server.comparisonEvents = [
    Promise.reject(new ConnectError("bad.obj:1: a vertex has three numbers", Code.InvalidArgument)),
  ];
  await comparisons.compare(fileOf("bad.obj"));
  expect(words()).toBe("bad.obj:1: a vertex has three numbers");
  expect(comparisons.result.value?.file).toBe("b.obj");
});

test("AStreamThatEndsEarlyIsAFailure", async () => {
  server.comparisonEvents = [vertices];
  await comparisons.compare(fileOf("b.obj"));
  expect(words()).toContain("without a result");
});

test("ATooLargeFileIsRefusedUnread", async () => {
  await comparisons.compare({ ...fileOf("big.msh", 16 << 20), arrayBuffer: () => Promise.reject(new Error("read")) });
  expect(words()).toContain("big.msh has 16.0 MiB");
  expect(server.comparisons).toEqual([]);
});

test("AnUnreadableFileIsReported", async () => {
  await comparisons.compare({ ...fileOf("gone.obj"), arrayBuffer: () => Promise.reject(new Error("gone")) });
  expect(words()).toContain("gone.obj cannot be read");
});

test("AnAnswerAfterStopIsIgnored", async () => {
  let answer = (_: ReturnType<typeof table>) => {};
  server.comparisonEvents = [vertices, new Promise<ReturnType<typeof table>>((resolve) => (answer = resolve))];
  void comparisons.compare(fileOf("b.obj"));
  await settle();
  expect(comparisons.progress.value.kind).toBe("running");
  comparisons.stop();
  answer(table(1));
  await settle();
  expect(comparisons.progress.value.kind).toBe("idle");
  expect(comparisons.result.value).toBeUndefined();
});

test("ANewerFileReplacesOneThatIsStillRead", async () => {
  let read = (_: ArrayBuffer) => {};
  void comparisons.compare({ ...fileOf("slow.obj"), arrayBuffer: () => new Promise((resolve) => (read = resolve)) });
  await comparisons.compare(fileOf("b.obj"));
  read(new ArrayBuffer(0));
  await settle();
  expect(server.comparisons.map(({ b }) => b?.name)).toEqual(["b.obj"]);
  expect(comparisons.progress.value.kind).toBe("idle");
});

test("ClearRemovesFileAndResult", async () => {
  await comparisons.compare(fileOf("b.obj"));
  comparisons.clear();
  expect(comparisons.result.value).toBeUndefined();
  await comparisons.repeat();
  expect(server.comparisons.length).toBe(1);
});
