import { expect, test, vi } from "vitest";
import { Measurements } from "../../../../web/src/appearance/measurements";
import { decodeBody } from "../../../../web/src/geometry/bodies";
import { MeasurePanel } from "../../../../web/src/panels/view/measure_panel";
import { NameLabels } from "../../../../web/src/panels/view/name_labels";
import type { NameLabel } from "../../../../web/src/viewer/names";
import { triangleBody } from "../../fakes/fake_server";

const body = decodeBody(triangleBody({}));
const arrays = { positions: body.rest, poses: new Float32Array() };
const at = (vertex: number) => ({ body: "triangle", vertex });

function measuring(): { measurements: Measurements; panel: MeasurePanel; button(id: string): HTMLButtonElement } {
  const measurements = new Measurements(
    () => [body],
    (ref) => ({ name: "Triangle", body: ref.body, vertices: undefined }),
  );
  const panel = new MeasurePanel(measurements);
  document.body.replaceChildren(panel.element, panel.hint);
  return { measurements, panel, button: (id) => document.querySelector<HTMLButtonElement>(`#measure-${id}`)! };
}

test("AToolIsPressedSaysWhatToClickAndIsLeft", () => {
  const { measurements, panel, button } = measuring();
  expect(panel.hint.hidden).toBe(true);
  button("angle").click();
  expect(["distance", "angle"].map((id) => button(id).ariaPressed)).toEqual(["false", "true"]);
  expect(panel.hint.textContent).toContain("Angle: click point 1 of 3");
  measurements.pick(at(0));
  expect(panel.hint.textContent).toContain("point 2 of 3");
  button("angle").click();
  expect([panel.hint.hidden, measurements.picked.value.length]).toEqual([true, 0]);
});

test("MeasurementsAreListedWithTheirValuesAndRemoved", () => {
  const { measurements, panel, button } = measuring();
  expect(button("clear").hidden).toBe(true);
  measurements.use("distance");
  for (const vertex of [0, 1]) measurements.pick(at(vertex));
  measurements.use("surface");
  measurements.pick(at(0));
  panel.show(arrays);
  const read = () => [...document.querySelectorAll(".measured td.reading")].map(({ textContent }) => textContent);
  expect(read()).toEqual(["1000 mm", "5000 cm²"]); // an open surface has no volume
  const [remove] = document.querySelectorAll<HTMLButtonElement>(".measured button");
  expect(remove.ariaLabel).toBe("Remove the measurement of Triangle");
  remove.click();
  panel.show(arrays);
  expect(read()).toEqual(["5000 cm²"]);
  button("clear").click();
  expect([read(), button("clear").hidden]).toEqual([[], true]);
});

const label = (name: string, fields: Partial<NameLabel> = {}): NameLabel => ({
  ...{ name, latin: "Costa", structure: true, ref: at(1), side: "left", x: 150, y: 50, width: 120, height: 36 },
  ...fields,
});

test("NamesOfStructuresAreButtonsThatChooseThem", () => {
  const choose = vi.fn();
  const names = new NameLabels(choose);
  document.body.replaceChildren(names.element);
  names.show([label("Rib"), label("A layer", { structure: false, latin: "" })]);
  const [rib, ...others] = names.element.querySelectorAll("button");
  expect([rib.textContent, others.length, rib.tabIndex]).toEqual(["RibCosta", 0, 0]);
  expect([rib.style.left, rib.style.top]).toEqual(["30px", "32px"]);
  rib.click();
  expect(choose).toHaveBeenCalledWith(at(1));
});

test("ALongNameTakesTheLineOfTheLatinOne", () => {
  const names = new NameLabels(() => undefined);
  names.show([label("Right 10th costal cartilage")]);
  expect(names.element.querySelector(".latin")).toBeNull();
  expect(names.element.querySelector("button")!.title).toBe("Costa");
});

test("TheFocusReturnsToItsNameAfterTheCameraMoved", () => {
  const names = new NameLabels(() => undefined);
  document.body.replaceChildren(names.element);
  const both = [label("Rib"), label("Lung")];
  names.show(both);
  names.element.querySelectorAll("button")[1].focus();
  names.show([]);
  expect(names.element.hidden).toBe(true);
  names.show(both.toReversed());
  expect(document.activeElement?.firstChild?.textContent).toBe("Lung");
});
