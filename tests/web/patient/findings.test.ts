import { create } from "@bufbuild/protobuf";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { afterEach, expect, test } from "vitest";
import {
  AssumptionKind,
  AssumptionSchema,
  FindingKind,
  PatientReportSchema,
  ReadinessFindingSchema,
} from "../../../web/src/gen/phrenic/v1/patient_pb";
import { InspectLabelsResponseSchema } from "../../../web/src/gen/phrenic/v1/patients_pb";
import { useMessages } from "../../../web/src/language/translate";
import { assumptionWords } from "../../../web/src/patient/assumption_words";
import { findingWords } from "../../../web/src/patient/finding_words";
import { LabelTable } from "../../../web/src/patient/label_table";

const languages = join(import.meta.dirname, "../../../web/public/languages");
const speak = (tag: string) => useMessages(JSON.parse(readFileSync(join(languages, `${tag}.json`), "utf8")), tag);
afterEach(() => useMessages({}, "en"));

const finding = (kind: FindingKind, parts: string[] = [], values: number[] = []) =>
  create(ReadinessFindingSchema, { kind, parts, values, what: "the server's English sentence" });

const examples = [
  finding(FindingKind.LUNG_CUT, ["lung-lower-lobe-left", "upper"], [31.6]),
  finding(FindingKind.RIBS_CUT, ["rib-7-left", "rib-8-left"]),
  finding(FindingKind.RIBS_MISSING, ["rib-1-right"]),
  finding(FindingKind.FILLED, ["rib-1-right", "heart"], [4.25, 0.12]),
  finding(FindingKind.ORGANS_MISSING, ["heart", "stomach-or-spleen"]),
  finding(FindingKind.EXTRAPOLATED, ["wall, left, back", "dome, right, front"], [0.49]),
  finding(FindingKind.ODD_AXES, ["rib-9-left"], [112]),
  finding(FindingKind.TOWER, [], [83]),
  finding(FindingKind.CROSSED, [], [21]),
  finding(FindingKind.ODD_AREA, [], [431]),
];

test("EveryKindHasWordsInEveryLanguageAndNoOptionOfTheCommandLine", () => {
  const kinds = Object.values(FindingKind).filter((kind) => typeof kind === "number" && kind > 0);
  expect(examples.map(({ kind }) => kind)).toEqual(kinds);
  const english = examples.map(findingWords);
  for (const words of english) expect(words).not.toMatch(/server's|undefined|NaN|\{|--/);
  for (const tag of ["de", "es"]) {
    speak(tag);
    for (const [i, example] of examples.entries()) {
      const words = findingWords(example);
      expect(words, tag).not.toBe(english[i]);
      expect(words, tag).not.toMatch(/undefined|NaN|\{|--|\bwall\b|\bupper\b|\bor\b/);
    }
  }
});

test("NumbersAndPartsAreThoseOfTheFinding", () => {
  speak("de");
  expect(findingWords(examples[0])).toContain("32 cm²");
  expect(findingWords(examples[3])).toContain("4,3 mm");
  expect(findingWords(examples[5])).toContain("Wand, links, hinten");
});

test("AKindOfALaterServerHasItsSentence", () => {
  expect(findingWords(finding(99 as FindingKind))).toBe("the server's English sentence");
});

const assumption = (kind: AssumptionKind, parts: string[] = [], values: number[] = []) =>
  create(AssumptionSchema, { kind, parts, values });

const assumed = [
  assumption(AssumptionKind.LUMBAR, [], [3, 33.2]),
  assumption(AssumptionKind.CAGE_WIDTH),
  assumption(AssumptionKind.NO_STERNUM),
  assumption(AssumptionKind.RIBS_LEFT_OUT, ["left"]),
  assumption(AssumptionKind.RIBS_DIVIDED, ["right"], [11]),
  assumption(AssumptionKind.GAPS_CLOSED, ["rib-7-left"], [98, 4]),
  assumption(AssumptionKind.MARGIN, [], [5]),
  assumption(AssumptionKind.WALL, [], [41.2, 1.26, 3]),
  assumption(AssumptionKind.TEMPLATE, ["rib-7-left", "heart"], [0.8, 0.91, 1, 4.2]),
];

test("EveryAssumptionHasWordsInEveryLanguage", () => {
  const kinds = Object.values(AssumptionKind).filter((kind) => typeof kind === "number" && kind > 0);
  expect(assumed.map(({ kind }) => kind)).toEqual(kinds);
  const fallbacks = assumed.map(() => "the server's English sentence");
  const report = create(PatientReportSchema, { fallbacks, assumptions: assumed });
  const english = assumptionWords(report);
  for (const words of english) expect(words).not.toMatch(/server's|undefined|NaN|\{/);
  expect(english[7]).toContain("no bone in 41 % of the directions, bridged; bones are 1.3 mm");
  for (const tag of ["de", "es"]) {
    speak(tag);
    for (const [i, words] of assumptionWords(report).entries()) {
      expect(words, tag).not.toBe(english[i]);
      expect(words, tag).not.toMatch(/undefined|NaN|\{|\bleft\b|\bthe\b/);
    }
  }
});

test("ARemarkAndAnAssumptionOfAnotherServerHaveTheirSentences", () => {
  const fallbacks = ["a.nii: has no labelled voxel", "of a later server", "of an earlier server"];
  const assumptions = [assumption(AssumptionKind.UNSPECIFIED), assumption(99 as AssumptionKind)];
  expect(assumptionWords(create(PatientReportSchema, { fallbacks, assumptions }))).toEqual(fallbacks);
});

const tools = [
  { name: "vista3d", title: "VISTA3D", agree: 57, differ: 1 },
  { name: "totalsegmentator", title: "TotalSegmentator", agree: 9, differ: 30 },
  { name: "moose-ribs", title: "MOOSE", agree: 1, differ: 20 },
];
const vector = { x: 1, y: 1, z: 1 };

test("TheMenuOfProgramsSaysWhichWasGuessedAndReadsByAnother", () => {
  const asked: string[] = [];
  const message = { voxels: { i: 1, j: 1, k: 1 }, spacingMm: vector, tools, map: "vista3d" };
  const { element } = new LabelTable(create(InspectLabelsResponseSchema, message), (map) => asked.push(map));
  const menu = element.querySelector<HTMLSelectElement>("#patient-tool")!;
  expect([...menu.options].map(({ text }) => text)).toEqual([
    "VISTA3D: 57 of 58 labels fit",
    "TotalSegmentator: 9 of 39 labels fit",
    "MOOSE ribs: 1 of 21 labels fit",
  ]);
  expect(menu.value).toBe("vista3d");
  expect(element.querySelector("#patient-guess")!.textContent).toMatch(/guess/);
  menu.value = "totalsegmentator";
  menu.dispatchEvent(new Event("change"));
  expect(asked).toEqual(["totalsegmentator"]);
});

test("AProgramThatFitsWorseIsSaid", () => {
  const message = { voxels: { i: 1, j: 1, k: 1 }, spacingMm: vector, tools, map: "totalsegmentator" };
  const { element } = new LabelTable(create(InspectLabelsResponseSchema, message), () => undefined);
  expect(element.querySelector(".fault")!.textContent).toBe("The numbers fit another program better: VISTA3D");
  const named = create(InspectLabelsResponseSchema, { ...message, tools: [], map: "" });
  expect(new LabelTable(named, () => undefined).element.querySelector("#patient-tool")).toBeNull();
});
