import { getOption } from "@bufbuild/protobuf";
import { make } from "../../dom/elements";
import { type SurfaceDistance, SurfaceDistanceSchema } from "../../gen/phrenic/v1/compare_pb";
import { quantity } from "../../gen/phrenic/v1/options_pb";
import { fixed } from "../../language/translate";

/** Measures by their names in the schema: body to file, file to body, and both. */
const rows: [label: string, names: (string | undefined)[]][] = [
  ["Mean", ["mean_a_to_b", "mean_b_to_a", "assd"]],
  ["RMS", ["rms_a_to_b", "rms_b_to_a", undefined]],
  ["95 %", ["p95_a_to_b", "p95_b_to_a", "hd95_max"]],
  ["Largest", ["hd_a_to_b", "hd_b_to_a", "hd_max"]],
];
const heads: [head: string, title: string][] = [
  ["Body → file", "From the body to the nearest point of the file's surface"],
  ["File → body", "From the file's surface to the nearest point of the body"],
  ["Both", "Both directions combined"],
];

/** Formats three decimals, one for 100 mm and more; "none" for NaN. */
export function formatMillimetres(value: number): string {
  if (Number.isNaN(value)) return "none";
  return fixed(value, value < 100 ? 3 : 1);
}

/** Returns a table of the measures of a comparison [mm] with their names in the schema. */
export function distanceTable(distance: SurfaceDistance): HTMLTableElement {
  const titles = heads.map(([head, title]) => make("th", { scope: "col", title }, head));
  const head = make("tr", {}, make("th", { scope: "col" }, "mm"), ...titles);
  const body = rows.map(([label, names]) => {
    const cells = names.map((name) => (name === undefined ? make("td") : cell(name, distance)));
    return make("tr", {}, make("th", { scope: "row" }, label), ...cells);
  });
  return make("table", { className: "figures" }, make("thead", {}, head), make("tbody", {}, ...body));
}

function cell(name: string, distance: SurfaceDistance): HTMLTableCellElement {
  const field = SurfaceDistanceSchema.fields.find((each) => each.name === name);
  if (field === undefined) throw new Error(`SurfaceDistance has no ${name}.`);
  const { label, help } = getOption(field, quantity);
  const value = distance[field.localName as keyof SurfaceDistance] as number;
  const number = make("b", {}, formatMillimetres(value));
  number.dataset.measure = name;
  return make("td", { title: help ? `${label}: ${help}` : label }, number, make("span", {}, name));
}
