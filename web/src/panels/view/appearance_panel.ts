import type { Coloring } from "../../appearance/coloring";
import { type FieldKind, fields, tissueFields } from "../../appearance/fields";
import type { GhostKind } from "../../appearance/ghosts";
import type { LayerStyles } from "../../appearance/layer_styles";
import { make } from "../../dom/elements";
import { labelledRow, section, switchRow } from "../../dom/rows";
import { forceKindLabel } from "../../session/force_queries";
import type { Signal } from "../../state/signal";
import type { Cut } from "../../viewer/clipping";
import type { OverlayKind } from "../../viewer/overlays";
import { cutRows } from "./cut_rows";
import { projectorRow } from "./projector_row";
import { type QualityChoice, qualityRow } from "./quality_row";
import { t } from "../../language/translate";

/** The settings that the panel changes. */
export interface AppearanceSettings {
  layerStyles: LayerStyles;
  overlays: Signal<ReadonlySet<OverlayKind>>;
  coloring: Coloring;
  labels: Signal<boolean>;
  forceKinds: Signal<string[]>;
  hasLungs: Signal<boolean>;
  cut: Signal<Cut>;
  /** Returns the position of a cut along its axis [m]. */
  cutAt(cut: Cut): number;
  ghost: Signal<GhostKind>;
  quality: Signal<QualityChoice>;
}

const overlayRows: [OverlayKind, string, string][] = [
  ["wireframe", "Show wireframe", "The edges of every surface."],
  ["links", "Show rigid links", "The links of constant length: the tensegrity."],
  ["lines", "Show action lines", "The lines along which the muscle pulls."],
  ["attachments", "Show attachments", "Vertices attached to bones, and fixed vertices."],
];

const ghosts: [GhostKind, string][] = [
  ["none", "None"],
  ["rest", "At rest"],
  ["expiration", "At the end of expiration"],
  ["now", "Current state"],
  ["beside", "The second view"],
];

/** A panel for colours, transparency, clipping, ghost, overlays and labels. */
export function appearancePanel(view: AppearanceSettings): HTMLElement {
  const ghost = choice("ghost", t("Ghost"), t("Deformable bodies in another state"), ghosts, (kind) =>
    view.ghost.set(kind),
  );
  view.ghost.subscribe((kind) => (ghost.querySelector("select")!.value = kind));
  const labels = switchRow(t("Show names"), t("Names of the visible structures (N)."), (on) => view.labels.set(on));
  view.labels.subscribe((on) => (labels.input.checked = on));
  labels.input.id = "show-labels";
  const rows = overlayRows.map(([kind, label, help]) => overlayRow(kind, t(label), t(help), view.overlays));
  const cut = cutRows(view.cut, view.cutAt);
  return section(
    t("View"),
    true,
    coloringRow(view.coloring, view.forceKinds, view.hasLungs),
    transparencyRow(view.layerStyles),
    ghost,
    ...cut,
    ...rows,
    labels.row,
    qualityRow(view.quality),
    projectorRow(),
  );
}

function coloringRow(coloring: Coloring, kinds: Signal<string[]>, hasLungs: Signal<boolean>): HTMLElement {
  const options: [FieldKind | "own", string][] = [
    ["own", "Layer colours"],
    ...fields.map(({ kind, label }): [FieldKind, string] => [kind, label]),
  ];
  const help = t("Field that colours the deformable bodies, or the lungs");
  const row = choice("coloring-kind", t("Colour by"), help, options, (kind) =>
    coloring.choose(kind === "own" ? undefined : kind),
  );
  coloring.field.subscribe((kind) => (row.querySelector("select")!.value = kind ?? "own"));
  const lungs = make("optgroup", { label: t("Lung tissue") });
  lungs.append(...tissueFields.map(({ kind, label }) => make("option", { value: kind }, t(label))));
  row.querySelector("select")?.append(lungs);
  hasLungs.subscribe((has) => (lungs.hidden = !has));
  // The available kinds of force are known later, and change when a vertex is pulled.
  const group = make("optgroup", { label: t("Force") });
  row.querySelector("select")?.append(group);
  kinds.subscribe((all) => {
    const wanted = all.map((kind) => make("option", { value: `force:${kind}` }, upper(t(forceKindLabel(kind)))));
    group.hidden = all.length === 0;
    group.replaceChildren(...wanted);
    row.querySelector("select")!.value = coloring.field.value ?? "own";
  });
  return row;
}

const upper = (words: string) => words.charAt(0).toUpperCase() + words.slice(1);

function choice<T extends string>(
  id: string,
  label: string,
  title: string,
  options: [T, string][],
  chosen: (value: T) => void,
): HTMLElement {
  const list = make("select", { id, title });
  list.append(...options.map(([value, words]) => make("option", { value }, t(words))));
  list.onchange = () => chosen(list.value as T);
  return labelledRow(id, label, list);
}

function overlayRow(
  kind: OverlayKind,
  label: string,
  help: string,
  overlays: Signal<ReadonlySet<OverlayKind>>,
): HTMLElement {
  const { row, input } = switchRow(label, help, (on) => {
    const rest = [...overlays.value].filter((each) => each !== kind);
    overlays.set(new Set(on ? [...rest, kind] : rest));
  });
  input.id = `show-${kind}`;
  overlays.subscribe((shown) => (input.checked = shown.has(kind)));
  return row;
}

function transparencyRow(layerStyles: LayerStyles): HTMLElement {
  const slider = make("input", { type: "range", id: "transparency", min: "0", max: "100", step: "1" });
  const output = make("output", { className: "unit" });
  slider.oninput = () => layerStyles.change(layerStyles.mainLayer, { opacity: 1 - slider.valueAsNumber / 100 });
  layerStyles.all.subscribe(() => {
    const percent = Math.round(100 * (1 - (layerStyles.get(layerStyles.mainLayer)?.opacity ?? 1)));
    slider.value = String(percent);
    slider.style.setProperty("--filled", `${percent}%`);
    output.textContent = `${percent} %`;
  });
  const label = make("label", { htmlFor: "transparency" }, t("Transparency"));
  return make("div", { className: "number-row plain" }, label, output, slider);
}
