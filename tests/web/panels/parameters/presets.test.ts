import { create } from "@bufbuild/protobuf";
import { beforeEach, describe, expect, test } from "vitest";
import { ParametersSchema } from "../../../../web/src/gen/phrenic/v1/parameters_pb";
import { SessionSchema } from "../../../../web/src/gen/phrenic/v1/session_pb";
import { PresetRow } from "../../../../web/src/panels/parameters/preset_row";
import { SessionController } from "../../../../web/src/session/session_controller";
import { FakeClock, settle } from "../../fakes/fake_clock";
import { FakeServer } from "../../fakes/fake_server";

let server: FakeServer;
let controller: SessionController;
let row: PresetRow;

const session = (revision: bigint, parameters: { breathForce?: number; ribMotion?: number }, scene = "thorax") =>
  create(SessionSchema, { revision, scene, parameters: create(ParametersSchema, parameters) });
const buttons = () => [...row.element.querySelectorAll("button")];
const pressed = () =>
  buttons()
    .filter((each) => each.ariaPressed === "true")
    .map((each) => each.textContent);

beforeEach(async () => {
  server = new FakeServer();
  server.presets = [
    { name: "quiet", title: "Quiet breath", parameters: { breathForce: 1, ribMotion: 1 } },
    { name: "deep", title: "Deep breath", parameters: { breathForce: 2, ribMotion: 3.3 } },
  ];
  controller = new SessionController(server.api, "thorax", new FakeClock());
  row = new PresetRow(controller);
  controller.receive(session(1n, { breathForce: 1, ribMotion: 1 }));
  await settle();
});

test("EachPresetHasAButton", () => {
  expect(buttons().map((each) => each.textContent)).toEqual(["Quiet breath", "Deep breath"]);
  expect(buttons().map((each) => each.title)).toEqual(["Quiet breath", "Deep breath"]);
  expect(row.element.hidden).toBe(false);
});

test("AButtonSendsItsPresetByName", async () => {
  buttons()[1].click();
  await settle();
  expect(server.updates).toEqual([{ preset: "deep" }]);
});

test("TheActivePresetIsPressed", () => {
  expect(pressed()).toEqual(["Quiet breath"]);
  controller.receive(session(2n, { breathForce: 2, ribMotion: 3.3 }));
  expect(pressed()).toEqual(["Deep breath"]);
  controller.receive(session(3n, { breathForce: 2, ribMotion: 1 }));
  expect(pressed()).toEqual([]);
});

describe("presets in groups", () => {
  const folds = () => [...row.element.querySelectorAll("details")];
  const open = () => folds().map((each) => each.open);
  const said = () => row.element.querySelector("p")!.textContent;

  beforeEach(async () => {
    server.presets = [
      { name: "quiet", group: "Breathing", description: "Both share.", parameters: { breathForce: 1, ribMotion: 1 } },
      { name: "palsy", title: "Palsy", group: "Disease", description: "One rests.", parameters: { breathForce: 0 } },
      { name: "deep-breath", group: "Breathing", description: "Both pull.", parameters: { breathForce: 2 } },
    ];
    controller.receive(session(2n, { breathForce: 1, ribMotion: 1 }, "another"));
    await settle();
  });

  test("StandBelowTheirHeadingInTheOrderOfTheScene", () => {
    expect(folds().map((each) => each.querySelector("summary")!.textContent)).toEqual(["Breathing", "Disease"]);
    const names = folds().map((each) => [...each.querySelectorAll("button")].map(({ textContent }) => textContent));
    expect(names).toEqual([["Quiet", "Deep breath"], ["Palsy"]]);
  });

  test("TheGroupOfTheActivePresetOpensOnceAndStaysAsTheUserFoldsIt", () => {
    expect(open()).toEqual([true, false]);
    controller.receive(session(3n, { breathForce: 0, ribMotion: 1 }, "another"));
    expect(open()).toEqual([true, true]);
    folds()[1].open = false;
    controller.receive(session(4n, { breathForce: 0, ribMotion: 1 }, "another"));
    expect(open()).toEqual([true, false]);
  });

  test("TheDescriptionFollowsTheActivePreset", () => {
    expect(said()).toBe("Both share.");
    controller.receive(session(3n, { breathForce: 0, ribMotion: 1 }, "another"));
    expect(said()).toBe("One rests.");
    controller.receive(session(4n, { breathForce: 9, ribMotion: 1 }, "another"));
    expect(said()).toBe("The parameters are those of no preset.");
  });
});

test("ASceneWithoutPresetsHasNoRow", async () => {
  server.presets = [];
  controller.receive(session(2n, {}, "cube-springs"));
  await settle();
  expect(row.element.hidden).toBe(true);
});

test("AnUnknownSceneHasNoPresetsAndNoError", async () => {
  server.down = true;
  controller.receive(session(2n, {}, "of-my-own"));
  await settle();
  expect(row.element.hidden).toBe(true);
  expect(controller.notice.value).toBe("");
});
