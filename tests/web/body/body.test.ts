import { readFileSync } from "node:fs";
import { join } from "node:path";
import { createRouterTransport } from "@connectrpc/connect";
import { Code, ConnectError } from "@connectrpc/connect";
import { beforeEach, describe, expect, test } from "vitest";
import { BodyDialog } from "../../../web/src/body/body_dialog";
import { controlsOfGroup, groups, readBodies } from "../../../web/src/body/body_numbers";
import { createApi } from "../../../web/src/connection/api";
import { type Physique, PhysiqueSchema, Sex } from "../../../web/src/gen/phrenic/v1/geometry_pb";
import { SessionService } from "../../../web/src/gen/phrenic/v1/session_pb";
import { settle } from "../fakes/fake_clock";

const list = readFileSync(join(import.meta.dirname, "../../../client/examples/bodies.txt"), "utf8");
const bodies = readBodies(list);
const controls = groups.flatMap((group) => controlsOfGroup(group));

test("TheListHasTheTenBodiesOfTheCommandLine", () => {
  expect(bodies).toHaveLength(10);
  expect(bodies[0]).toEqual({ title: "Man, 30 years, 1.75 m", numbers: {} });
  expect(bodies[1]).toEqual({ title: "Woman, 30 years, 1.62 m", numbers: { sex: Sex.FEMALE } });
  expect(bodies[4].numbers).toEqual({ height: 1.95, chestWidth: 0.92, chestDepth: 0.9 });
  expect(() => readBodies("x: hight=2")).toThrow("no number hight");
  expect(() => readBodies("x: sex=femal")).toThrow("no sex femal");
});

test("EveryNumberOfTheSchemaHasAControlWithItsHelpAndRange", () => {
  expect(controls.map(({ control }) => control.field).sort()).toEqual(
    PhysiqueSchema.fields.map(({ localName }) => localName).sort(),
  );
  for (const { control, neutral } of controls) {
    expect(control.help).not.toBe("");
    if (control.kind !== "number") continue;
    expect(control.minimum).toBeLessThan(control.maximum);
    expect(control.automatic, control.field).toBe(neutral !== undefined);
    if (neutral === undefined) continue;
    expect(neutral).toBeGreaterThanOrEqual(control.minimum);
    expect(neutral).toBeLessThanOrEqual(control.maximum);
  }
});

describe("the dialog", () => {
  let asked: (Physique | undefined)[], opened: string[], dialog: BodyDialog, refuse: boolean;
  const entry = (field: string) => dialog.element.querySelector<HTMLInputElement>(`#parameter-${field}-entry`)!;
  const ready = (title: string) => [...dialog.element.querySelectorAll("button")].find((b) => b.textContent === title)!;
  const press = async (id: string) => {
    dialog.element.querySelector<HTMLButtonElement>(id)!.click();
    await settle();
  };
  const enter = (field: string, value: string) => {
    entry(field).value = value;
    entry(field).dispatchEvent(new Event("change"));
  };

  beforeEach(() => {
    [asked, opened, refuse] = [[], [], false];
    const transport = createRouterTransport(({ service }) =>
      service(SessionService, {
        createSession: ({ source }) => {
          if (refuse) throw new ConnectError("the server is full", Code.ResourceExhausted);
          expect(source?.source).toEqual({ case: "name", value: "thorax" });
          asked.push(source?.physique);
          return { session: { id: "s" } };
        },
        playSession: () => ({}),
      }),
    );
    dialog = new BodyDialog(createApi(transport), (id) => opened.push(id));
    document.body.replaceChildren(dialog.element);
  });

  test("SendsWhatIsSetInSiUnitsAndNothingElse", async () => {
    enter("height", "1.9");
    enter("rightDomeHeight", "12");
    await press("#body-start");
    expect(opened).toEqual(["s"]);
    expect(asked[0]).toMatchObject({ height: 1.9, rightDomeHeight: 0.012 });
    for (const field of ["sex", "age", "chestWidth", "leftDomeHeight"]) expect(asked[0]).not.toHaveProperty(field);
  });

  test("ShowsAReadyBodyAndLeavesTheRestToSexAndAge", async () => {
    ready("Small woman, 1.5 m").click();
    expect(entry("height").value).toBe("1.5");
    expect(entry("chestWidth").value).toBe("");
    expect(entry("chestWidth").placeholder).toBe("auto");
    expect(ready("Small woman, 1.5 m").ariaPressed).toBe("true");
    enter("height", "1.6");
    expect(ready("Small woman, 1.5 m").ariaPressed).toBe("false");
    await press("#body-reset");
    expect(ready("Man, 30 years, 1.75 m").ariaPressed).toBe("true");
    await press("#body-start");
    expect(asked[0]).not.toHaveProperty("height");
  });

  test("RefusesANumberOutsideItsRangeWithTheRange", async () => {
    enter("height", "3");
    expect(dialog.element.querySelector("#parameter-height-fault")!.textContent).toBe(
      "Height must be between 1.2 and 2.2 m.",
    );
    await press("#body-start");
    expect(asked[0]).not.toHaveProperty("height");
  });

  test("SaysWhyTheServerRefuses", async () => {
    refuse = true;
    await press("#body-start");
    expect(opened).toEqual([]);
    expect(dialog.element.querySelector("footer .fault")!.textContent).toContain("the server is full");
    expect(dialog.element.querySelector<HTMLButtonElement>("#body-start")!.disabled).toBe(false);
  });
});
