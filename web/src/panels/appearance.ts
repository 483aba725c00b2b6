import type { Look, Looks } from "../looks";
import type { OverlayKind } from "../viewer/body_view";
import { make, section, switchRow } from "./dom";

/** Transparency of what the simulation is about, and what is drawn over it: this viewer's business alone. */
export function appearancePanel(looks: Looks, setOverlay: (kind: OverlayKind, on: boolean) => void): HTMLElement {
  const overlays: [OverlayKind, string, string][] = [
    ["wireframe", "Show wireframe", "The edges of every surface."],
    ["links", "Show rigid links", "The links of constant length: the tensegrity."],
    ["lines", "Show action lines", "The lines along which the muscle pulls."],
    ["attachments", "Show attachments", "Vertices that follow a bone, and fixed ones."],
  ];
  const rows = overlays.map(([kind, label, help]) => {
    const { row, input } = switchRow(label, help, (on) => setOverlay(kind, on));
    input.id = `show-${kind}`;
    return row;
  });
  return section("View", true, transparencyRow(looks), ...rows);
}

function transparencyRow(looks: Looks): HTMLElement {
  const slider = make("input", { type: "range", id: "transparency", min: "0", max: "100", step: "1" });
  const output = make("output", { className: "unit" });
  slider.oninput = () => looks.change(looks.main, { opacity: 1 - slider.valueAsNumber / 100 });
  looks.all.subscribe(() => {
    const percent = Math.round(100 * (1 - (looks.get(looks.main)?.opacity ?? 1)));
    slider.value = String(percent);
    slider.style.setProperty("--filled", `${percent}%`);
    output.textContent = `${percent} %`;
  });
  const label = make("label", { htmlFor: "transparency" }, "Transparency");
  return make("div", { className: "number-row plain" }, label, output, slider);
}

/** Visibility and opacity of every layer. */
export function layersPanel(looks: Looks): HTMLElement {
  const list = make("div", { className: "layers" });
  let shown = "";
  looks.all.subscribe((all) => {
    const names = all.map((look) => look.layer).join("\n");
    if (names !== shown) list.replaceChildren(...all.map((look) => layerRow(look, looks)));
    shown = names;
  });
  return section("Layers", true, list);
}

function layerRow({ layer, title, color }: Look, looks: Looks): HTMLElement {
  const swatch = make("span", { className: "swatch" });
  swatch.style.backgroundColor = color;
  const visible = make("input", { type: "checkbox", ariaLabel: `Show ${title}` });
  const opacity = make("input", { type: "range", min: "5", max: "100", step: "1", ariaLabel: `Opacity of ${title}` });
  visible.onchange = () => looks.change(layer, { visible: visible.checked });
  opacity.oninput = () => looks.change(layer, { opacity: opacity.valueAsNumber / 100, visible: true });
  looks.all.subscribe(() => {
    const look = looks.get(layer);
    if (look === undefined) return;
    visible.checked = look.visible;
    opacity.value = String(Math.round(100 * look.opacity));
    opacity.setAttribute("aria-valuetext", `${opacity.value} %`);
    opacity.style.setProperty("--filled", `${((100 * look.opacity - 5) / 95) * 100}%`);
  });
  const name = make("label", { className: "layer-name" }, visible, swatch, make("span", {}, title));
  return make("div", { className: "layer-row" }, name, opacity);
}
