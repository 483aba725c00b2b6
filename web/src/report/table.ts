import type { DescField, DescMessage, Message } from "@bufbuild/protobuf";
import { isFieldSet, ScalarType } from "@bufbuild/protobuf";
import { make } from "../dom/elements";
import { formatDigits } from "./format";
import { headingOf } from "./headings";
import { seriesName } from "./names";

const marks: Record<string, [string, string]> = {
  pass: ["✔", "good"],
  ok: ["✔", "good"],
  stable: ["✔", "good"],
  stopped: ["■", "warn"],
  FAILED: ["✖", "bad"],
  holds: ["✔", "good"],
  fails: ["✖", "bad"],
  "no evidence": ["■", "warn"],
  "not measured": ["■", "warn"],
};

/** A table of messages of one type, with a column for each field that is set in some row. */
export function tableOf(title: string, schema: DescMessage, rows: readonly Message[]): HTMLElement {
  const heading = make("h3", {}, title);
  if (rows.length === 0) return make("section", {}, heading, make("p", { className: "none" }, "No rows."));
  const fields = schema.fields.filter((field) => rows.some((row) => isShown(row, field)));
  const head = make("tr", {}, ...fields.map((field) => headCell(field)));
  const body = rows.map((row) => make("tr", {}, ...fields.map((field) => cell(row, field))));
  const table = make("table", {}, make("thead", {}, head), make("tbody", {}, ...body));
  const scroller = make("div", { className: "scroller", tabIndex: 0, role: "region", ariaLabel: title }, table);
  return make("section", { className: "table" }, heading, scroller);
}

// Shows zeros and false, but no text column that is empty in all rows.
function isShown(row: Message, field: DescField): boolean {
  if (field.fieldKind !== "scalar") return false;
  const value = valueOf(row, field);
  return value !== undefined && value !== "";
}

function valueOf(row: Message, field: DescField): unknown {
  const optional = field.proto.proto3Optional;
  if (optional && !isFieldSet(row, field)) return undefined;
  return (row as unknown as Record<string, unknown>)[field.localName];
}

function headCell(field: DescField): HTMLElement {
  const cell = make("th", { scope: "col" }, headingOf(field.name));
  if (isNumber(field)) cell.className = "number";
  return cell;
}

function isNumber(field: DescField): boolean {
  return field.fieldKind === "scalar" && field.scalar !== ScalarType.BOOL && field.scalar !== ScalarType.STRING;
}

function cell(row: Message, field: DescField): HTMLElement {
  const value = valueOf(row, field);
  if (value === undefined || value === "") return make("td", { className: isNumber(field) ? "number" : "" }, "–");
  if (typeof value === "boolean") return make("td", {}, value ? "✔ yes" : "no");
  if (typeof value === "bigint") return make("td", { className: "number" }, formatDigits(Number(value), 12));
  if (typeof value === "number") return make("td", { className: "number" }, shortDigits(value));
  const text = String(value);
  if (field.name === "verdict") return verdictCell(text);
  return make(
    "td",
    { className: text.length > 30 ? "words" : "" },
    field.name === "integrator" ? seriesName(text) : text,
  );
}

/** Formats four digits, or three with a power of ten. */
function shortDigits(value: number): string {
  const size = Math.abs(value);
  return formatDigits(value, size !== 0 && (size < 1e-3 || size >= 1e6) ? 3 : 4);
}

function verdictCell(text: string): HTMLElement {
  const [mark, className] = marks[text] ?? (text.startsWith("diverged") ? ["✖", "bad"] : ["", ""]);
  const icon = make("span", { className: "mark", ariaHidden: "true" }, mark);
  return make("td", { className: `verdict ${className}`.trim() }, ...(mark === "" ? [] : [icon, " "]), text);
}
