import { create } from "@bufbuild/protobuf";
import { Code, ConnectError } from "@connectrpc/connect";
import { beforeEach, expect, test } from "vitest";
import { Controller } from "../../web/src/controller";
import { SessionSchema } from "../../web/src/gen/phrenic/v1/session_pb";
import { FakeClock, settle } from "./fake_clock";
import { FakeServer } from "./fake_server";

let server: FakeServer;
let controller: Controller;

const at = (revision: bigint) => create(SessionSchema, { id: "thorax", revision });

beforeEach(() => {
  server = new FakeServer();
  controller = new Controller(server.api, "thorax", new FakeClock());
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
