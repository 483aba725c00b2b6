import { create } from "@bufbuild/protobuf";
import { createClient, createRouterTransport } from "@connectrpc/connect";
import { beforeEach, expect, test } from "vitest";
import { Identity, identityInterceptor } from "../../../web/src/connection/identity";
import { type Control, ControlPolicy, ControlSchema, ControlService } from "../../../web/src/gen/phrenic/v1/control_pb";
import { SessionSchema, SessionService } from "../../../web/src/gen/phrenic/v1/session_pb";
import type { CameraPose } from "../../../web/src/geometry/camera_pose";
import { CameraSharing } from "../../../web/src/session/camera_sharing";
import { controlLabel, Participation, refusalReason, rolesOf } from "../../../web/src/session/participation";
import { SessionController } from "../../../web/src/session/session_controller";
import { FakeClock, settle } from "../fakes/fake_clock";
import { FakeServer } from "../fakes/fake_server";

class FakeStorage {
  private readonly values = new Map<string, string>();
  getItem = (key: string) => this.values.get(key) ?? null;
  setItem = (key: string, value: string) => void this.values.set(key, value);
}

const people = (controller: string, revision = 1n): Control =>
  create(ControlSchema, {
    policy: controller === "" ? ControlPolicy.EVERYBODY : ControlPolicy.OWNER,
    controller,
    owner: "Anna",
    participants: [{ name: "Anna", owner: true }, { name: "Ben" }],
    revision,
  });

let identity: Identity;
let clock: FakeClock;
let server: FakeServer;
let controller: SessionController;
let participation: Participation;

beforeEach(() => {
  identity = new Identity(new FakeStorage());
  clock = new FakeClock();
  server = new FakeServer();
  controller = new SessionController(server.api, "thorax", clock);
  participation = new Participation(server.api, controller, identity, clock);
});

const receive = (controls: string, revision = 1n) =>
  controller.receive(create(SessionSchema, { id: "thorax", revision: 1n, control: people(controls, revision) }));

async function enterAs(name: string) {
  server.api.control.enterSession = () => Promise.resolve({ controlToken: "t" } as never);
  await participation.enter(name);
}

test("WithoutAControllerEveryoneMayChange", () => {
  const roles = rolesOf(people(""), "");
  expect([roles.mayChange, controlLabel(roles), refusalReason(roles)]).toEqual([true, "Everyone controls", ""]);
});

test("OnlyTheControllerMayChange", () => {
  expect(rolesOf(people("Anna"), "Anna")).toMatchObject({ hasControl: true, mayChange: true, mayHandOver: true });
  expect(rolesOf(people("Anna"), "Ben")).toMatchObject({ hasControl: false, mayChange: false, mayHandOver: false });
  expect(rolesOf(people("Ben"), "Anna")).toMatchObject({ mayChange: false, mayHandOver: true });
  expect(refusalReason(rolesOf(people("Anna"), ""))).toContain("Anna controls");
});

test("AnUnlistedNameIsASpectator", () => {
  expect(rolesOf(people("Zoe"), "Zoe")).toMatchObject({ name: "", hasControl: false });
});

test("OlderControlNeverReplacesNewer", () => {
  receive("Ben", 5n);
  receive("Anna", 4n);
  expect(controller.session.value?.control?.controller).toBe("Ben");
  controller.receiveControl(people("Anna", 6n));
  expect(controller.session.value?.control?.controller).toBe("Anna");
});

test("UnchangedRolesAreNotSetAgain", () => {
  let shown = 0;
  participation.roles.subscribe(() => shown++);
  receive("Anna");
  receive("Anna");
  expect(shown).toBe(2);
  receive("Ben", 2n);
  expect(shown).toBe(3);
});

test("CallsCarryTokensAndResponsesStoreThem", async () => {
  const asked: string[] = [];
  const transport = createRouterTransport(
    ({ service }) => {
      service(SessionService, {
        createSession: ({ ownerName }) => (asked.push(ownerName), { session: { id: "mine" }, controlToken: "secret" }),
        pauseSession: ({ controlToken }) => (asked.push(controlToken), {}),
      });
      service(ControlService, {});
    },
    { transport: { interceptors: [identityInterceptor(identity)] } },
  );
  const sessions = createClient(SessionService, transport);
  identity.name = "Anna";
  await sessions.createSession({});
  await sessions.pauseSession({ sessionId: "mine" });
  await sessions.pauseSession({ sessionId: "other" });
  expect(asked).toEqual(["Anna", "secret", ""]);
});

test("OnlyRecentTokensAreKept", () => {
  for (let i = 0; i <= 200; i++) identity.storeToken(`s-${i}`, `t-${i}`);
  expect([identity.tokenOf("s-0"), identity.tokenOf("s-1"), identity.tokenOf("s-200")]).toEqual(["", "t-1", "t-200"]);
});

test("TheControllerSendsItsCameraAndOthersMayFollow", async () => {
  const shown: CameraPose[] = [];
  const moved: CameraPose[] = [];
  server.api.control.showCamera = ((request: { camera: CameraPose }) => {
    shown.push(request.camera);
    return Promise.resolve({});
  }) as never;
  const camera = {
    pose: { eye: { x: 1, y: 0, z: 0 }, target: { x: 0, y: 0, z: 0 } },
    moveTo: (p: CameraPose) => moved.push(p),
  };
  await enterAs("Ben");
  receive("Anna");
  const sharing = new CameraSharing(server.api, "thorax", participation, camera, clock);
  const remotePose = { eye: { x: 9, y: 0, z: 0 }, target: { x: 0, y: 0, z: 0 } };
  sharing.sendIfMoved();
  sharing.receive(remotePose as never);
  expect([shown.length, moved.length]).toEqual([0, 0]);
  identity.followsCamera = true;
  sharing.follow();
  expect(moved).toMatchObject([remotePose]);
  receive("Ben", 2n);
  await settle();
  sharing.receive(remotePose as never);
  sharing.sendIfMoved();
  await settle();
  expect(shown).toEqual([camera.pose]);
  expect(moved.length).toBe(1);
});
