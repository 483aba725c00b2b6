import { beforeEach, expect, test } from "vitest";
import { forceUnit } from "../../../web/src/panels/view/force_table";
import { ForceQueries } from "../../../web/src/session/force_queries";
import { FakeServer } from "../fakes/fake_server";

let server: FakeServer;
let forces: ForceQueries;
const vertex = { body: "sheet", vertex: 1 };

beforeEach(() => {
  server = new FakeServer();
  forces = new ForceQueries(server.api, "thorax");
});

test("NoQueryWithoutARequest", async () => {
  await forces.query({ vertex: undefined, kind: undefined, bodies: ["sheet"] }, "1");
  expect(server.forceRequests).toEqual([]);
});

test("EachStateIsQueriedOnce", async () => {
  const wanted = { vertex, kind: undefined, bodies: [] };
  await Promise.all([forces.query(wanted, "1"), forces.query(wanted, "1")]);
  await forces.query(wanted, "1");
  expect(server.forceRequests.length).toBe(1);
  await forces.query(wanted, "2");
  expect(server.forceRequests.length).toBe(2);
  expect(forces.onVertex.value).toEqual([
    { kind: "springs", force: [1, 2, 3] },
    { kind: "net", force: [1, 2, 3] },
  ]);
});

test("MagnitudesCoverEveryVertexOfEachBody", async () => {
  await forces.query({ vertex: undefined, kind: "net", bodies: ["sheet", "ball"] }, "1");
  expect(server.forceRequests).toEqual([
    { body: "sheet", kind: "net" },
    { body: "ball", kind: "net" },
  ]);
  expect([...forces.magnitudes.value.get("ball")!]).toEqual([0.5, 0.25]);
});

test("AFailedQueryShowsNoForces", async () => {
  await forces.query({ vertex, kind: "net", bodies: ["sheet"] }, "1");
  server.down = true;
  await forces.query({ vertex, kind: "net", bodies: ["sheet"] }, "2");
  expect([forces.onVertex.value, forces.magnitudes.value.size]).toEqual([[], 0]);
});

test("SmallForcesAreInMillinewtons", () => {
  expect(forceUnit([{ kind: "net", force: [0, 0.6, 0.79] }])).toEqual({ name: "mN", factor: 1000 });
  expect(forceUnit([{ kind: "net", force: [0, 0.6, 0.81] }])).toEqual({ name: "N", factor: 1 });
});

test("StoredForcesAreShownDuringReplay", async () => {
  const wanted = { vertex: undefined, kind: "net", bodies: ["sheet"] };
  const tell = async (time: number, size: number) => {
    server.forceResponse = { time, sizes: [size, size] };
    await forces.query(wanted, String(time));
  };
  await tell(1, 0.25);
  await tell(2, 0.5);
  const shown = () => forces.magnitudes.value.get("sheet")?.[0];
  forces.replayAt(1.05, wanted);
  expect(shown()).toBe(0.25);
  forces.replayAt(1.5, wanted);
  expect(shown()).toBeUndefined();
  forces.replayAt(1, { ...wanted, kind: "springs" });
  expect(shown()).toBeUndefined();
  // An answer that arrives during replay belongs to the live state and is not shown.
  forces.replayAt(1, wanted);
  await tell(3, 0.75);
  expect(shown()).toBe(0.25);
  forces.replayAt(undefined, wanted);
  await tell(3.1, 1);
  expect(shown()).toBe(1);
});

test("AResetClearsTheStoredForces", async () => {
  const wanted = { vertex, kind: undefined, bodies: [] };
  server.forceResponse = { time: 5, sizes: [] };
  await forces.query(wanted, "1");
  server.forceResponse = { time: 1, sizes: [] };
  await forces.query(wanted, "2");
  forces.replayAt(5, wanted);
  expect(forces.onVertex.value).toEqual([]);
  forces.replayAt(1, wanted);
  expect(forces.onVertex.value.length).toBe(2);
});
