import { create } from "@bufbuild/protobuf";
import { expect, test } from "vitest";
import { SessionSchema, SessionState } from "../../../web/src/gen/phrenic/v1/session_pb";
import { chooseSession, preferredSession } from "../../../web/src/session/choose_session";
import { FakeClock, settle } from "../fakes/fake_clock";
import { FakeServer } from "../fakes/fake_server";

/** A session; the newest has the largest `seconds`. */
const session = (id: string, scene: string, state: SessionState, seconds = 0, others = {}) =>
  create(SessionSchema, { id, scene, state, createTime: { seconds: BigInt(seconds) }, ...others });
const plain = new URL("http://127.0.0.1:8080/");
const { DIVERGED, PAUSED, PLAYING } = SessionState;

test("ThePreferredSessionPlaysAThorax", () => {
  const order = [
    session("watched", "thorax", PLAYING, 1, { viewers: 3 }),
    session("scoliosis", "thorax-scoliosis", PLAYING, 9),
    session("person", "person-1", PLAYING, 8),
    session("patient", "anna", PLAYING, 7, { sceneTitle: "Thorax of anna, from a label volume" }),
    session("a-cube", "cube-springs", PLAYING, 9),
    session("rests", "thorax", PAUSED, 2),
    session("rests-longer", "thorax", PAUSED, 1),
    session("another-cube", "cube-springs", PAUSED, 9, { viewers: 1 }),
    session("burst", "thorax", DIVERGED, 9),
    session("copy", "thorax", PLAYING, 9, { temporary: true, viewers: 9 }),
  ];
  for (let i = 0; i < order.length; i++) {
    const left = order.slice(i);
    expect(preferredSession(left)?.id).toBe(order[i].id);
    expect(preferredSession(left.toReversed())?.id).toBe(order[i].id);
  }
  expect(preferredSession([])).toBeUndefined();
});

test("TheFirstOfEqualSessionsIsPreferred", () => {
  const equal = ["a", "b"].map((id) => session(id, "thorax", PLAYING));
  expect(preferredSession(equal)?.id).toBe("a");
});

test("TheSessionInTheAddressIsUsed", async () => {
  const named = new URL("?session=mine", plain);
  expect(await chooseSession(named, new FakeServer().api, new FakeClock(), () => {})).toBe("mine");
});

test("AServerWithoutASessionIsPolled", async () => {
  const [server, clock, heard] = [new FakeServer(), new FakeClock(), [] as unknown[]];
  server.sessions = [];
  const chosen = chooseSession(plain, server.api, clock, (error) => heard.push(error));
  await settle();
  expect(heard).toEqual([undefined]);
  server.sessions = [server.session];
  await clock.advance(1500);
  expect(await chosen).toBe("thorax");
});

test("AnUnreachableServerIsPolled", async () => {
  const [server, clock, heard] = [new FakeServer(), new FakeClock(), [] as unknown[]];
  server.down = true;
  const chosen = chooseSession(plain, server.api, clock, (error) => heard.push(error));
  await settle();
  expect(String(heard[0])).toContain("connection refused");
  server.down = false;
  await clock.advance(500);
  expect(await chosen).toBe("thorax");
});
