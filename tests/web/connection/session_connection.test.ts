import { afterEach, beforeEach, expect, test } from "vitest";
import {
  type ConnectionListener,
  type ConnectionState,
  SessionConnection,
} from "../../../web/src/connection/session_connection";
import { Codec } from "../../../web/src/gen/phrenic/v1/frames_pb";
import { Backoff } from "../../../web/src/timing/backoff";
import { FakeClock, settle } from "../fakes/fake_clock";
import { FakeServer } from "../fakes/fake_server";

let server: FakeServer;
let clock: FakeClock;
let states: ConnectionState[];
let ticks: bigint[];
let epochs: bigint[];
let freshSessions: number;
let connection: SessionConnection;

const listener: ConnectionListener = {
  state: (link) => (states.at(-1)?.kind === link.kind && link.kind === "live" ? undefined : states.push(link)),
  scene: () => {},
  session: (_session, fresh) => (freshSessions += fresh ? 1 : 0),
  frame: (frame) => ticks.push(frame.tick),
  basis: ({ epoch }) => epochs.push(epoch),
  acknowledged: () => {},
};

const kinds = () => states.map((link) => link.kind);
const frame = (tick: bigint) => ({ case: "frame" as const, value: { tick } });

beforeEach(() => {
  [server, clock, states, ticks, epochs, freshSessions] = [new FakeServer(), new FakeClock(), [], [], [], 0];
  connection = new SessionConnection(server.api, "thorax", listener, clock, new Backoff(500, 10_000, () => 0));
  void connection.run();
});

afterEach(() => connection.stop());

test("TheConnectionIsLiveAfterTheFirstMessage", async () => {
  expect(kinds()).toEqual(["connecting"]);
  await settle();
  expect(kinds()).toEqual(["connecting", "live"]);
});

test("FramesArriveInOrder", async () => {
  await settle();
  for (const tick of [1n, 2n, 3n]) {
    server.send(frame(tick));
    await settle();
  }
  expect(ticks).toEqual([1n, 2n, 3n]);
});

test("ALostServerIsReportedAndRetriedWithBackoff", async () => {
  await settle();
  server.kill();
  await settle();
  expect(states.at(-1)).toMatchObject({
    kind: "lost",
    reason: "connection reset",
    missing: false,
    retryAt: 500,
  });
  await clock.advance(500);
  expect(states.at(-1)).toMatchObject({
    kind: "lost",
    reason: "connection refused",
    retryAt: 500 + 1000,
  });
  await clock.advance(1000);
  expect(states.at(-1)).toMatchObject({ kind: "lost", retryAt: 1500 + 2000 });
});

test("ReconnectingResetsTheBackoff", async () => {
  await settle();
  server.kill();
  await clock.advance(500);
  server.down = false;
  await clock.advance(1000);
  expect(states.at(-1)).toEqual({ kind: "live" });
  expect(freshSessions).toBe(2);
  server.kill();
  await settle();
  expect(states.at(-1)).toMatchObject({
    kind: "lost",
    retryAt: clock.now() + 500,
  });
});

test("TheSameSceneIsFetchedOnce", async () => {
  await settle();
  server.kill();
  server.down = false;
  await clock.advance(500);
  expect(states.at(-1)).toEqual({ kind: "live" });
  expect(server.geometryCalls).toBe(1);
});

test("ASceneWithAnotherHashIsFetchedAgain", async () => {
  await settle();
  server.kill();
  [server.down, server.sceneHash] = [false, "other"];
  await clock.advance(500);
  expect(server.geometryCalls).toBe(2);
});

test("AServerThatStopsAnsweringIsDetected", async () => {
  await settle();
  // The stream stays open, but calls fail.
  server.down = true;
  await clock.advance(2000);
  expect(states.at(-1)).toMatchObject({
    kind: "lost",
    reason: "connection refused",
  });
});

test("ASessionOnAnotherServerIsReconnected", async () => {
  await settle();
  // The stream of a disconnected server stays open.
  server.session.epoch = 2n;
  await clock.advance(2000);
  expect(states.at(-1)).toMatchObject({ kind: "lost", reason: "The session has moved." });
  await clock.advance(500);
  expect(states.at(-1)).toEqual({ kind: "live" });
  expect(freshSessions).toBe(2);
});

test("RetryNowEndsTheWait", async () => {
  await settle();
  server.kill();
  await settle();
  server.down = false;
  connection.retryNow();
  await settle();
  expect(states.at(-1)).toEqual({ kind: "live" });
});

test("FramesAreAcknowledgedAndFailuresRetried", async () => {
  await settle();
  server.send({ case: "frame" as const, value: { sequence: 7n } });
  await settle();
  expect(server.acknowledged).toEqual([7n]);
  server.down = true;
  server.send({ case: "frame" as const, value: { sequence: 9n } });
  await settle();
  server.down = false;
  await clock.advance(500);
  expect(server.acknowledged).toEqual([7n, 9n, 9n]);
});

test("NoCallsAfterStop", async () => {
  await settle();
  connection.stop();
  const before = states.length;
  await clock.advance(60_000);
  expect(states.length).toBe(before);
});

test("ExactFramesRestartTheWatchWithoutReportingALoss", async () => {
  await settle();
  connection.setExact(true);
  await settle();
  connection.setExact(true);
  await settle();
  expect(server.errorBounds).toEqual([undefined, 0.01]);
  server.send(frame(7n));
  await settle();
  expect(ticks).toEqual([7n]);
  expect(kinds()).toEqual(["connecting", "live"]);
});

test("ChosenBodiesRestartTheWatchWithoutReportingALoss", async () => {
  await settle();
  for (const bodies of [["diaphragm"], ["diaphragm"], []]) {
    connection.setBodies(bodies);
    await settle();
  }
  expect(server.chosenBodies).toEqual([[], ["diaphragm"], []]);
  expect(kinds()).toEqual(["connecting", "live"]);
});

test("ABasisIsFetchedOnceAndReportedToTheServer", async () => {
  server.basis.epoch = 4n;
  await settle();
  connection.setCodec(Codec.BASIS);
  await settle();
  expect(server.codecs).toEqual([Codec.PREDICTED, Codec.BASIS]);
  for (const tick of [1n, 2n, 3n]) {
    server.send({ case: "frame", value: { tick, sequence: tick } });
    await settle();
  }
  expect(epochs).toEqual([4n]);
  expect(server.reportedBasisEpochs).toEqual([0n, 4n, 4n]);
});
