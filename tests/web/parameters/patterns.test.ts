import { create } from "@bufbuild/protobuf";
import { expect, test } from "vitest";
import { ParametersSchema } from "../../../web/src/gen/phrenic/v1/parameters_pb";
import { withoutPattern } from "../../../web/src/parameters/patterns";

test("ABreathOfAnotherPatternKeepsWhatThePersonHas", () => {
  const preset = create(ParametersSchema, {
    breathLength: 6,
    diaphragmActivation: 0.8,
    rightActivation: 1,
    posture: 1,
  });
  const now = create(ParametersSchema, { breathLength: 4, diaphragmActivation: 0.07, rightActivation: 0, posture: 2 });
  expect(withoutPattern(preset, now)).toEqual({ rightActivation: 0, posture: 2 });
});
