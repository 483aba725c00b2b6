import type { Look, Looks } from "../../appearance/layer_styles";
import { make } from "../../dom/elements";
import { section } from "../../dom/rows";

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
