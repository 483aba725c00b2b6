import { beforeEach, expect, test } from "vitest";
import { unitFor } from "../../../web/src/panels/view/force_table";
import { Forces } from "../../../web/src/session/force_queries";
import { FakeServer } from "../fakes/fake_server";

let server: FakeServer;
let forces: Forces;
const vertex = { body: "sheet", vertex: 1 };

beforeEach(() => {
  server = new FakeServer();
  forces = new Forces(server.api, "thorax");
});

test("NothingIsAskedThatNobodyWantsToKnow", async () => {
  await forces.ask({ vertex: undefined, kind: undefined, bodies: ["sheet"] }, "1");
  expect(server.forceQuestions).toEqual([]);
});

test("OneStateIsAskedForOnceHoweverOftenItIsWanted", async () => {
  const wanted = { vertex, kind: undefined, bodies: [] };
  await Promise.all([forces.ask(wanted, "1"), forces.ask(wanted, "1")]);
  await forces.ask(wanted, "1");
  expect(server.forceQuestions.length).toBe(1);
  await forces.ask(wanted, "2");
  expect(server.forceQuestions.length).toBe(2);
  expect(forces.onVertex.value).toEqual([
    { kind: "springs", force: [1, 2, 3] },
    { kind: "net", force: [1, 2, 3] },
  ]);
});

test("AKindComesForEveryVertexOfEachBody", async () => {
  await forces.ask({ vertex: undefined, kind: "net", bodies: ["sheet", "ball"] }, "1");
  expect(server.forceQuestions).toEqual([
    { body: "sheet", kind: "net" },
    { body: "ball", kind: "net" },
  ]);
  expect([...forces.sizes.value.get("ball")!]).toEqual([0.5, 0.25]);
});

test("WhereTheServerDoesNotSayNothingIsShown", async () => {
  await forces.ask({ vertex, kind: "net", bodies: ["sheet"] }, "1");
  server.down = true;
  await forces.ask({ vertex, kind: "net", bodies: ["sheet"] }, "2");
  expect([forces.onVertex.value, forces.sizes.value.size]).toEqual([[], 0]);
});

test("SmallForcesAreToldInThousandths", () => {
  expect(unitFor([{ kind: "net", force: [0, 0.6, 0.79] }])).toEqual({ name: "mN", factor: 1000 });
  expect(unitFor([{ kind: "net", force: [0, 0.6, 0.81] }])).toEqual({ name: "N", factor: 1 });
});

test("WhatWasToldOfAMomentIsShownToWhoLooksBackAtIt", async () => {
  const wanted = { vertex: undefined, kind: "net", bodies: ["sheet"] };
  const tell = async (time: number, size: number) => {
    server.forcesTold = { time, sizes: [size, size] };
    await forces.ask(wanted, String(time));
  };
  await tell(1, 0.25);
  await tell(2, 0.5);
  const shown = () => forces.sizes.value.get("sheet")?.[0];
  forces.recall(1.05, wanted);
  expect(shown()).toBe(0.25);
  forces.recall(1.5, wanted);
  expect(shown()).toBeUndefined();
  forces.recall(1, { ...wanted, kind: "springs" });
  expect(shown()).toBeUndefined();
  // What comes meanwhile is of the present.
  forces.recall(1, wanted);
  await tell(3, 0.75);
  expect(shown()).toBe(0.25);
  forces.recall(undefined, wanted);
  await tell(3.1, 1);
  expect(shown()).toBe(1);
});

test("AnotherRunOfTheSessionHasForcesOfItsOwn", async () => {
  const wanted = { vertex, kind: undefined, bodies: [] };
  server.forcesTold = { time: 5, sizes: [] };
  await forces.ask(wanted, "1");
  server.forcesTold = { time: 1, sizes: [] };
  await forces.ask(wanted, "2");
  forces.recall(5, wanted);
  expect(forces.onVertex.value).toEqual([]);
  forces.recall(1, wanted);
  expect(forces.onVertex.value.length).toBe(2);
});
