import { describe, expect, test } from "vitest";
import { ParametersSchema } from "../../../web/src/gen/phrenic/v1/parameters_pb";
import {
  type ChoiceControl,
  choiceLabel,
  type NumberControl,
  parameterControls,
} from "../../../web/src/parameters/controls";
import { formatNumber, rangeError, sliderPosition, sliderValue } from "../../../web/src/parameters/numbers";

const controls = parameterControls();
const numbers = controls.filter((control): control is NumberControl => control.kind === "number");
const find = (field: string) => numbers.find((control) => control.field === field)!;

describe("controls from the schema", () => {
  test("EveryParameterHasAControlInTheOrderOfTheSchema", () => {
    expect(controls.map((control) => control.field)).toEqual(ParametersSchema.fields.map((field) => field.localName));
  });

  test("EachHasALabelAndHelp", () => {
    for (const { label, help } of controls) expect([label.length > 0, help.length > 0]).toEqual([true, true]);
  });

  test("ThoseOfAGroupStandTogether", () => {
    const groups = controls.map(({ group }) => group);
    const runs = groups.filter((group, i) => group !== groups[i - 1]);
    expect(runs).toEqual([...new Set(groups)]);
    expect(groups).not.toContain("");
  });

  test("RangesUnitsAndDefaultsAreFieldOptions", () => {
    expect(find("breathLength")).toMatchObject({
      unit: "s",
      minimum: 0.5,
      maximum: 30,
      defaultValue: 4,
      step: 0.1,
    });
    expect(find("breathForce").unit).toBe("");
    expect(controls.find((control) => control.field === "applyMuscles")).toMatchObject({
      kind: "switch",
      defaultValue: true,
    });
  });

  test("RangesOverThreeDecadesAreLogarithmic", () => {
    expect(numbers.filter((control) => control.logarithmic).map((control) => control.field)).toEqual([
      "lungCompliance",
      "airwayResistance",
      "chestWallCompliance",
      "rightCageCompliance",
      "leftCageCompliance",
      "abdominalCompliance",
      "elasticity",
      "timeStep",
    ]);
  });
});

describe("a choice", () => {
  const choices = controls.filter((control): control is ChoiceControl => control.kind === "choice");

  test("OffersEveryValueExceptTheUnspecifiedOne", () => {
    for (const { field, options } of choices) {
      const { values } = ParametersSchema.field[field as "integrator"].enum!;
      expect(options.map(({ value }) => value)).toEqual(values.map(({ number }) => number).filter(Boolean));
    }
    expect(choices.map(({ field }) => field)).toContain("integrator");
  });

  test("HasADefaultAmongItsValues", () => {
    for (const { options, defaultValue } of choices) expect(options.map(({ value }) => value)).toContain(defaultValue);
  });

  test("FormatsTheNamesOfItsValues", () => {
    expect(choices.find(({ field }) => field === "integrator")!.options[0]).toEqual({
      value: 1,
      label: "Semi Implicit Euler",
    });
    const names = ["VELOCITY_VERLET", "RUNGE_KUTTA_4", "TR_BDF2"];
    expect(names.map(choiceLabel)).toEqual(["Velocity Verlet", "Runge Kutta 4", "TR BDF2"]);
  });
});

describe("a slider", () => {
  test("RoundTripsItsValues", () => {
    for (const control of numbers) {
      for (const value of [control.minimum, control.maximum, control.defaultValue || control.minimum]) {
        expect(sliderValue(control, sliderPosition(control, value))).toBeCloseTo(value, 9);
      }
    }
  });

  test("StaysInTheRange", () => {
    for (const control of numbers) {
      for (const position of [-1e3, 1e3]) expect(rangeError(control, sliderValue(control, position))).toBeUndefined();
    }
  });
});

describe("a typed number", () => {
  test("OutOfRangeIsRefusedWithTheRange", () => {
    expect(rangeError(find("breathLength"), 31)).toBe("Breath length must be between 0.5 and 30 s.");
    expect(rangeError(find("breathForce"), -0.1)).toBe("Breath force must be between 0 and 20.");
  });

  test("ThatIsNaNIsRefused", () => {
    expect(rangeError(find("breathLength"), NaN)).toBeDefined();
  });

  test("IsFormattedWithFourDigits", () => {
    expect([0.1 + 0.2, 1234.56, 1.5e-5].map(formatNumber)).toEqual(["0.3", "1235", "0.000015"]);
  });
});
