import { create } from "@bufbuild/protobuf";
import { Code, ConnectError } from "@connectrpc/connect";
import { beforeEach, expect, test } from "vitest";
import { Controller } from "../../web/src/controller";
import { ParametersSchema } from "../../web/src/gen/phrenic/v1/parameters_pb";
import { SessionSchema, SessionState } from "../../web/src/gen/phrenic/v1/session_pb";
import { FakeClock, settle } from "./fake_clock";
import { FakeServer } from "./fake_server";

let server: FakeServer;
let clock: FakeClock;
let controller: Controller;

const at = (revision: bigint) => create(SessionSchema, { id: "thorax", revision });

beforeEach(() => {
  server = new FakeServer();
  clock = new FakeClock();
  controller = new Controller(server.api, "thorax", clock);
});

test("AnOlderStateNeverReplacesANewerOne", () => {
  controller.receive(at(5n));
  controller.receive(at(4n));
  expect(controller.session.value?.revision).toBe(5n);
});

test("AFreshConnectionMayStartOver", () => {
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

test("ARefusalIsShownInTheServersWords", async () => {
  server.api.sessions.playSession = () =>
    Promise.reject(new ConnectError("speed: 1000 is above 100", Code.InvalidArgument));
  await controller.play(1000);
  expect(controller.notice.value).toBe("speed: 1000 is above 100");
});

test("AChangeIsTakenBackToWhatHeldBefore", async () => {
  controller.receive(create(SessionSchema, { revision: 1n, parameters: create(ParametersSchema, { breathForce: 1 }) }));
  controller.set("breathForce", 1.5);
  await clock.advance(100);
  controller.undo();
  await settle();
  expect(server.updates).toMatchObject([{ breathForce: 1.5 }, { breathForce: 1 }]);
  expect(controller.changes.state.value).toEqual({ undo: false, redo: true });
});

test("AForkOfAPlayingSessionPlays", async () => {
  let played = "";
  server.api.sessions.playSession = (({ sessionId }: { sessionId: string }) => {
    played = sessionId;
    return Promise.resolve({ session: undefined });
  }) as unknown as typeof server.api.sessions.playSession;
  controller.receive(create(SessionSchema, { state: SessionState.PLAYING }));
  expect(await controller.fork()).toBe("thorax-2");
  expect(played).toBe("thorax-2");
});
