import { create } from "@bufbuild/protobuf";
import { beforeEach, expect, test } from "vitest";
import { FrameSchema } from "../../../../web/src/gen/phrenic/v1/frames_pb";
import { ParametersSchema } from "../../../../web/src/gen/phrenic/v1/parameters_pb";
import { PresetSchema } from "../../../../web/src/gen/phrenic/v1/scene_pb";
import { SessionSchema } from "../../../../web/src/gen/phrenic/v1/session_pb";
import { presetComparison } from "../../../../web/src/panels/comparison/preset_comparison";
import { domeLabel } from "../../../../web/src/panels/comparison/view_headers";
import { SessionController } from "../../../../web/src/session/session_controller";
import { Signal } from "../../../../web/src/state/signal";
import { FakeClock, settle } from "../../fakes/fake_clock";
import { FakeServer } from "../../fakes/fake_server";

const presets = new Signal([
  create(PresetSchema, { name: "quiet", parameters: { rightActivation: 1 } }),
  create(PresetSchema, { name: "paralysis-right", parameters: { rightActivation: 0 } }),
]);
let server: FakeServer;
let controller: SessionController;
let opened: string[];

const listOf = (row: HTMLElement) => row.querySelector("select")!;
function choose(name: string): void {
  const list = listOf(presetComparison(controller, presets, (query) => opened.push(query)));
  list.value = name;
  list.dispatchEvent(new Event("change"));
}

beforeEach(() => {
  server = new FakeServer();
  controller = new SessionController(server.api, "thorax", new FakeClock());
  opened = [];
});

test("ACopyWithTheChosenPresetOpensBesideThisSession", async () => {
  choose("paralysis-right");
  await settle();
  expect(server.updates).toEqual([{ preset: "paralysis-right" }]);
  expect(opened).toEqual(["?session=thorax&beside=thorax-2"]);
});

test("WithTwoViewsTheSecondOneChanges", async () => {
  controller.companion = new SessionController(server.api, "other", new FakeClock());
  choose("paralysis-right");
  await settle();
  expect(server.updates).toEqual([{ preset: "paralysis-right" }]);
  expect(opened).toEqual([]);
});

test("TheListShowsThePresetOfTheSecondSession", () => {
  controller.companion = new SessionController(server.api, "other", new FakeClock());
  const list = listOf(presetComparison(controller, presets, () => undefined));
  expect(list.value).toBe("");
  const parameters = create(ParametersSchema, { rightActivation: 0 });
  controller.companion.receive(create(SessionSchema, { revision: 2n, parameters }));
  expect(list.value).toBe("paralysis-right");
});

test("ASceneWithoutPresetsHidesTheList", () => {
  expect(presetComparison(controller, new Signal(presets.value.slice(0, 0)), () => undefined).hidden).toBe(true);
});

test("DomeHeightsComeFromMeasuresFirst", () => {
  const frame = create(FrameSchema, {
    measures: [
      { name: "right dome", value: -0.0243, unit: "m" },
      { name: "dome height", value: 0.1, unit: "m" },
    ],
    probes: [{ name: "right summit", dz: -0.0622 }],
  });
  expect(domeLabel(frame)).toBe("right dome 24.3 mm down");
});

test("DomeHeightsAreFormatted", () => {
  const probe = (name: string, dz: number) => ({ name, dz });
  const frame = create(FrameSchema, {
    probes: [probe("right dome", 0.0021), probe("rib", 1), probe("left dome", -0.0143)],
  });
  expect(domeLabel(frame)).toBe("right dome 2.1 mm up, left dome 14.3 mm down");
  expect(domeLabel(undefined)).toBe("");
});
