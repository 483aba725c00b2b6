import { create } from "@bufbuild/protobuf";
import { make } from "../dom/elements";
import { type LabelMeaning, LabelMeaningSchema } from "../gen/phrenic/v1/patient_pb";
import type { FoundLabel, InspectLabelsResponse } from "../gen/phrenic/v1/patients_pb";
import { fixed, t } from "../language/translate";
import { missingName, nameOf } from "./structure_names";

/** The labels of a volume, each with a menu of what it is. */
export class LabelTable {
  readonly element: HTMLElement;
  private readonly menus: { number: number; menu: HTMLSelectElement }[] = [];

  constructor(
    private readonly table: InspectLabelsResponse,
    /** Reads the labels by another program's map. */
    private readonly readBy: (map: string) => void,
  ) {
    this.element = make("div", {}, ...this.facts(), ...this.tools(), this.rows());
  }

  /** Returns the meanings that the menus show, by the volume's numbers; labels that are not used are left out. */
  meanings(): LabelMeaning[] {
    return this.menus.flatMap(({ number, menu }) => {
      const choice = this.table.choices.find(({ name }) => name === menu.value);
      return choice === undefined ? [] : [create(LabelMeaningSchema, { ...choice, number })];
    });
  }

  private facts(): HTMLElement[] {
    const { voxels, spacingMm, lowMm, highMm, labels, remarks, missing } = this.table;
    const size = t("{0} × {1} × {2} voxels", voxels!.i, voxels!.j, voxels!.k);
    const spacing = [spacingMm!.x, spacingMm!.y, spacingMm!.z].map((edge) => fixed(edge, 2)).join(" × ");
    const unknown = labels.filter(({ proposed }) => proposed === undefined).length;
    const lines = [`${this.table.format}: ${size}, ${spacing} mm`];
    if (lowMm !== undefined && highMm !== undefined) {
      const range = (low: number, high: number) => `${fixed(low, 0)} … ${fixed(high, 0)}`;
      const { x, y, z } = highMm;
      const [left, back, up] = [range(lowMm.x, x), range(lowMm.y, y), range(lowMm.z, z)];
      lines.push(t("Frame of the scan: left {0}, back {1}, up {2} mm", left, back, up));
    }
    lines.push(t("{0} labels, {1} of them unknown", labels.length, unknown));
    const facts = lines.map((line) => make("p", { className: "faint" }, line));
    if (missing.length > 0) {
      const needed = missing.filter((each) => each.needed).map(missingName);
      const wanted = missing.filter((each) => !each.needed).map(missingName);
      if (needed.length > 0)
        facts.push(make("p", { className: "fault" }, t("Needed and missing: {0}", needed.join(", "))));
      if (wanted.length > 0) facts.push(make("p", { id: "patient-missing" }, t("Missing: {0}", wanted.join(", "))));
    }
    return [...facts, ...remarks.map((remark) => make("p", { className: "faint" }, remark))];
  }

  /** Returns a menu of the programs that number labels, if numbers count. */
  private tools(): HTMLElement[] {
    const { tools, map } = this.table;
    if (tools.length === 0) return [];
    const menu = make("select", { id: "patient-tool" });
    for (const { name, title, agree, differ } of tools) {
      const words = t("{0}: {1} of {2} labels fit", toolName(title, name), agree, agree + differ);
      menu.append(make("option", { value: name, selected: name === map }, words));
    }
    menu.onchange = () => this.readBy(menu.value);
    const used = tools.find(({ name }) => name === map);
    const better = used !== undefined && tools[0].agree - tools[0].differ > used.agree - used.differ;
    const guessed = t("The labels have numbers and no names. The program was guessed from their sizes and positions.");
    const other = t("The numbers fit another program better: {0}", toolName(tools[0].title, tools[0].name));
    return [
      make("p", { className: better ? "fault" : "faint", id: "patient-guess" }, better ? other : guessed),
      make("p", {}, make("label", { htmlFor: menu.id }, t("Program that made the labels")), " ", menu),
    ];
  }

  private rows(): HTMLElement {
    const heads = [t("Number"), t("Name in the file"), t("Structure"), t("Volume")];
    const head = make("tr", {}, ...heads.map((words) => make("th", { scope: "col" }, words)));
    // Unknown labels come first: they are to be named.
    const sorted = this.table.labels.toSorted(
      (a, b) => Number(a.proposed !== undefined) - Number(b.proposed !== undefined),
    );
    const rows = sorted.map((label) => this.row(label));
    return make(
      "div",
      { className: "label-rows", tabIndex: 0 },
      make("table", {}, make("thead", {}, head), make("tbody", {}, ...rows)),
    );
  }

  private row(label: FoundLabel): HTMLElement {
    const { number, name, volumeMl, atBorder, proposed } = label;
    const menu = make("select", { ariaLabel: t("Structure of label {0}", number) });
    menu.append(make("option", { value: "" }, proposed === undefined ? t("unknown, not used") : t("not used")));
    for (const choice of this.table.choices) {
      menu.append(make("option", { value: choice.name, selected: choice.name === proposed?.name }, nameOf(choice)));
    }
    this.menus.push({ number, menu });
    const volume = make("td", {}, `${fixed(volumeMl, volumeMl < 10 ? 1 : 0)} ml`);
    if (atBorder) volume.append(make("span", { className: "faint" }, ` ${t("at the border")}`));
    const row = make("tr", {}, make("td", {}, String(number)), make("td", {}, name), make("td", {}, menu), volume);
    row.dataset.label = String(number);
    return row;
  }
}

/** Returns a program's name, with the model that has a file of its own: "MOOSE ribs". */
function toolName(title: string, map: string): string {
  const model = /-(.*)/.exec(map)?.[1];
  return model === undefined ? title : `${title} ${model}`;
}
