import { readFileSync } from "node:fs";
import { join } from "node:path";
import { create } from "@bufbuild/protobuf";
import { expect, test } from "vitest";
import { ParametersSchema } from "../../../web/src/gen/phrenic/v1/parameters_pb";
import { PresetSchema } from "../../../web/src/gen/phrenic/v1/scene_pb";
import { presetCauses } from "../../../web/src/parameters/causes";
import { activationsOf, breathLengthOf, effortOf, fullActivations } from "../../../web/src/parameters/effort";

const scene = readFileSync(join(import.meta.dirname, "../../../server/scenes/thorax.textproto"), "utf8");

test("ActivationsAreTheInverseOfTheEffort", () => {
  const { depth, belly } = effortOf(create(ParametersSchema, activationsOf(0.25, 0.7)));
  expect(depth).toBeCloseTo(0.25, 4);
  expect(belly).toBeCloseTo(0.7, 4);
});

test("TheDeepestBreathOfTheSceneIsFullEffort", () => {
  const deep = scene.slice(scene.indexOf('name: "deep"'));
  const value = (name: string) => Number(new RegExp(`${name}: ([0-9.]+)`).exec(deep)?.[1]);
  expect(value("diaphragm_activation")).toBe(fullActivations.diaphragm);
  expect(value("intercostal_activation")).toBe(fullActivations.intercostal);
  expect(effortOf(create(ParametersSchema, activationsOf(1, 0.5))).depth).toBeCloseTo(1, 6);
});

test("RestingMusclesHaveNoShareOfTheDiaphragm", () => {
  const none = create(ParametersSchema, { diaphragmActivation: 0, intercostalActivation: 0, breathLength: 3 });
  expect(effortOf(none)).toEqual({ depth: 0, rate: 20, belly: undefined });
});

test("EveryGroupOfTheThoraxHasACauseInPlainWords", () => {
  const groups = [...scene.matchAll(/^ {2}group: "(.*)"$/gm)].map(([, group]) => group);
  const presets = groups.map((group, i) => create(PresetSchema, { name: String(i), group }));
  const causes = presetCauses(presets);
  expect([...causes.keys()]).toEqual(["Healthy", "Ill", "Machine"]);
  expect([...causes.values()].flat().length).toBe(groups.length);
});

test("GroupsThatTheSceneMixesStandTogether", () => {
  const groups = ["Manoeuvres", "Breathing patterns", "Manoeuvres", "Breathing patterns"];
  const presets = groups.map((group, i) => create(PresetSchema, { name: String(i), group }));
  expect(presetCauses(presets).get("Healthy")!.map(({ name }) => name)).toEqual(["1", "3", "0", "2"]); // prettier-ignore
});

test("ABreathWithoutALengthTakesFourSeconds", () => {
  expect([undefined, { breathLength: 5 }].map(breathLengthOf)).toEqual([4, 5]);
});

test("AnUnknownGroupIsACauseOfItsOwn", () => {
  const presets = ["Support", "Animals", ""].map((group) => create(PresetSchema, { name: group, group }));
  expect([...presetCauses(presets).keys()]).toEqual(["Machine", "Animals", "Breaths"]);
});
