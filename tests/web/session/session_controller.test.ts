import { create } from "@bufbuild/protobuf";
import { Code, ConnectError } from "@connectrpc/connect";
import { beforeEach, expect, test } from "vitest";
import { ParametersSchema } from "../../../web/src/gen/phrenic/v1/parameters_pb";
import { SessionSchema, SessionState } from "../../../web/src/gen/phrenic/v1/session_pb";
import { SessionController } from "../../../web/src/session/session_controller";
import { FakeClock, settle } from "../fakes/fake_clock";
import { FakeServer } from "../fakes/fake_server";

let server: FakeServer;
let clock: FakeClock;
let controller: SessionController;

const at = (revision: bigint) => create(SessionSchema, { id: "thorax", revision });

beforeEach(() => {
  server = new FakeServer();
  clock = new FakeClock();
  controller = new SessionController(server.api, "thorax", clock);
});

test("OlderStatesNeverReplaceNewer", () => {
  controller.receive(at(5n));
  controller.receive(at(4n));
  expect(controller.session.value?.revision).toBe(5n);
});

test("AFreshConnectionAcceptsAnyRevision", () => {
  controller.receive(at(5n));
  controller.receive(at(1n), true);
  expect(controller.session.value?.revision).toBe(1n);
});

test("OnlyTheChangedParameterIsSent", async () => {
  controller.set("breathForce", 1.5);
  await settle();
  expect(server.updates).toMatchObject([{ breathForce: 1.5 }]);
  expect(server.updates[0]).not.toHaveProperty("ribMotion");
});

test("ARefusalShowsTheServersMessage", async () => {
  server.api.sessions.playSession = () =>
    Promise.reject(new ConnectError("speed: 1000 is above 100", Code.InvalidArgument));
  await controller.play(1000);
  expect(controller.notice.value).toBe("speed: 1000 is above 100");
});

test("UndoRestoresThePreviousValue", async () => {
  controller.receive(create(SessionSchema, { revision: 1n, parameters: create(ParametersSchema, { breathForce: 1 }) }));
  controller.set("breathForce", 1.5);
  await clock.advance(100);
  controller.undo();
  await settle();
  expect(server.updates).toMatchObject([{ breathForce: 1.5 }, { breathForce: 1 }]);
  expect(controller.changes.state.value).toEqual({ undo: false, redo: true });
});

test("AForkOfAPlayingSessionPlaysAndTheOriginalContinues", async () => {
  controller.receive(create(SessionSchema, { state: SessionState.PLAYING }));
  expect(await controller.fork()).toBe("thorax-2");
  expect(server.played).toEqual([["thorax-2", ""]]);
  expect(server.paused).toEqual([]);
});

test("AForkForComparisonStartsAtTheSameTimeAndPlaysInStep", async () => {
  controller.receive(create(SessionSchema, { state: SessionState.PLAYING, speed: 0.5 }));
  expect(await controller.forkForComparison("deep")).toBe("thorax-2");
  await settle();
  expect(server.paused).toEqual(["thorax"]);
  expect(server.updates).toEqual([{ preset: "deep" }]);
  expect(server.played).toEqual(
    expect.arrayContaining([
      ["thorax", "thorax-2"],
      ["thorax-2", "thorax"],
    ]),
  );
});

test("AForkOfAPausedSessionLeavesBothPaused", async () => {
  controller.receive(create(SessionSchema, { state: SessionState.PAUSED }));
  expect(await controller.forkForComparison()).toBe("thorax-2");
  expect([server.paused, server.played]).toEqual([[], []]);
});

test("PausedCompanionsAreAtTheSameTime", async () => {
  const parameters = create(ParametersSchema, { timeStep: 0.001 });
  const standing = (time: number) => create(SessionSchema, { revision: 2n, time, parameters });
  server.pausedSessions.set("thorax", standing(1)).set("other", standing(1.012));
  controller.companion = new SessionController(server.api, "other", clock);
  await controller.pause();
  expect(server.stepped).toEqual([["thorax", 12n]]);
  server.pausedSessions.set("thorax", standing(9));
  await controller.pause();
  expect(server.stepped).toHaveLength(1);
});
