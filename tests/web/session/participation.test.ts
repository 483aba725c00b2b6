import { create } from "@bufbuild/protobuf";
import { createClient, createRouterTransport } from "@connectrpc/connect";
import { beforeEach, expect, test } from "vitest";
import { Identity, signing } from "../../../web/src/connection/identity";
import { type Control, ControlPolicy, ControlSchema, ControlService } from "../../../web/src/gen/phrenic/v1/control_pb";
import { SessionSchema, SessionService } from "../../../web/src/gen/phrenic/v1/session_pb";
import type { Pose } from "../../../web/src/geometry/camera_pose";
import { CameraLead } from "../../../web/src/session/camera_sharing";
import { controlWords, refusalWords, rolesOf, Standing } from "../../../web/src/session/participation";
import { Controller } from "../../../web/src/session/session_controller";
import { FakeClock, settle } from "../fakes/fake_clock";
import { FakeServer } from "../fakes/fake_server";

class FakeMemory {
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
let controller: Controller;
let standing: Standing;

beforeEach(() => {
  identity = new Identity(new FakeMemory());
  clock = new FakeClock();
  server = new FakeServer();
  controller = new Controller(server.api, "thorax", clock);
  standing = new Standing(server.api, controller, identity, clock);
});

const receive = (controls: string, revision = 1n) =>
  controller.receive(create(SessionSchema, { id: "thorax", revision: 1n, control: people(controls, revision) }));

async function enterAs(name: string) {
  server.api.control.enterSession = () => Promise.resolve({ controlToken: "t" } as never);
  await standing.enter(name);
}

test("EverybodyMayChangeWhatNobodyControls", () => {
  const roles = rolesOf(people(""), "");
  expect([roles.mayChange, controlWords(roles), refusalWords(roles)]).toEqual([true, "Everybody controls", ""]);
});

test("OnlyWhoControlsMayChange", () => {
  expect(rolesOf(people("Anna"), "Anna")).toMatchObject({ alone: true, mayChange: true, mayHand: true });
  expect(rolesOf(people("Anna"), "Ben")).toMatchObject({ alone: false, mayChange: false, mayHand: false });
  expect(rolesOf(people("Ben"), "Anna")).toMatchObject({ mayChange: false, mayHand: true });
  expect(refusalWords(rolesOf(people("Anna"), ""))).toContain("Anna controls");
});

test("ANameThatTheServerDoesNotListIsNobodys", () => {
  expect(rolesOf(people("Zoe"), "Zoe")).toMatchObject({ me: "", alone: false });
});

test("AnOlderWordAboutControlNeverReplacesANewerOne", () => {
  receive("Ben", 5n);
  receive("Anna", 4n);
  expect(controller.session.value?.control?.controller).toBe("Ben");
  controller.receiveControl(people("Anna", 6n));
  expect(controller.session.value?.control?.controller).toBe("Anna");
});

test("NothingIsShownAnewWhereNothingChanged", () => {
  let shown = 0;
  standing.roles.subscribe(() => shown++);
  receive("Anna");
  receive("Anna");
  expect(shown).toBe(2);
  receive("Ben", 2n);
  expect(shown).toBe(3);
});

test("CallsAreSignedAndAnsweredTokensAreKept", async () => {
  const asked: string[] = [];
  const transport = createRouterTransport(
    ({ service }) => {
      service(SessionService, {
        createSession: ({ ownerName }) => (asked.push(ownerName), { session: { id: "mine" }, controlToken: "secret" }),
        pauseSession: ({ controlToken }) => (asked.push(controlToken), {}),
      });
      service(ControlService, {});
    },
    { transport: { interceptors: [signing(identity)] } },
  );
  const sessions = createClient(SessionService, transport);
  identity.name = "Anna";
  await sessions.createSession({});
  await sessions.pauseSession({ sessionId: "mine" });
  await sessions.pauseSession({ sessionId: "other" });
  expect(asked).toEqual(["Anna", "secret", ""]);
});

test("TokensOfTheLastSessionsAreKeptAndNoMore", () => {
  for (let i = 0; i <= 200; i++) identity.keepToken(`s-${i}`, `t-${i}`);
  expect([identity.tokenOf("s-0"), identity.tokenOf("s-1"), identity.tokenOf("s-200")]).toEqual(["", "t-1", "t-200"]);
});

test("TheCameraIsShownByWhoControlsAndFollowedByWhoWantsTo", async () => {
  const shown: Pose[] = [];
  const placed: Pose[] = [];
  server.api.control.showCamera = (({ camera }: { camera: Pose }) => {
    shown.push(camera);
    return Promise.resolve({});
  }) as never;
  const stage = {
    pose: { eye: { x: 1, y: 0, z: 0 }, target: { x: 0, y: 0, z: 0 } },
    place: (p: Pose) => placed.push(p),
  };
  await enterAs("Ben");
  receive("Anna");
  const lead = new CameraLead(server.api, "thorax", standing, stage, clock);
  const theirs = { eye: { x: 9, y: 0, z: 0 }, target: { x: 0, y: 0, z: 0 } };
  lead.drawn();
  lead.receive(theirs as never);
  expect([shown.length, placed.length]).toEqual([0, 0]);
  identity.follows = true;
  lead.follow();
  expect(placed).toMatchObject([theirs]);
  receive("Ben", 2n);
  await settle();
  lead.receive(theirs as never);
  lead.drawn();
  await settle();
  expect(shown).toEqual([stage.pose]);
  expect(placed.length).toBe(1);
});
