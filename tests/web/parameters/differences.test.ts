import { create } from "@bufbuild/protobuf";
import { expect, test } from "vitest";
import { ParametersSchema } from "../../../web/src/gen/phrenic/v1/parameters_pb";
import { differences, shortDifferences } from "../../../web/src/parameters/differences";

const parameters = create(ParametersSchema, { breathForce: 1 / 3, applyLinks: false, integrator: 4 });

test("ParameterDifferencesAreFormatted", () => {
  const other = create(ParametersSchema, { breathForce: 2, applyLinks: true, integrator: 4 });
  expect(differences(parameters, other)).toBe("Breath force 2 instead of 0.3333, Apply rigid links on instead of off");
  expect(differences(parameters, parameters)).toBe("");
  expect(shortDifferences(parameters, other)).toBe(differences(parameters, other));
  const [here, there] = [3, 4].map((n) => create(ParametersSchema, { breathForce: n, ribMotion: n, elasticity: n }));
  expect(shortDifferences(here, there)).toBe("With breath force 4, rib motion 4, elasticity 4");
});
