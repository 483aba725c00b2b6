import type { LayerStyle, LayerStyles } from "../../appearance/layer_styles";
import { make } from "../../dom/elements";
import { section } from "../../dom/rows";
import { t } from "../../language/translate";

/** A panel for visibility and opacity of each layer. */
export function layersPanel(layerStyles: LayerStyles): HTMLElement {
  const list = make("div", { className: "layers" });
  let shown = "";
  layerStyles.all.subscribe((all) => {
    const names = all.map((style) => style.layer).join("\n");
    if (names !== shown) list.replaceChildren(...all.map((look) => layerRow(look, layerStyles)));
    shown = names;
  });
  return section(t("Layers"), true, list);
}

function layerRow({ layer, title: english, color }: LayerStyle, layerStyles: LayerStyles): HTMLElement {
  const title = t(english);
  const swatch = make("span", { className: "swatch" });
  swatch.style.backgroundColor = color;
  const visible = make("input", { type: "checkbox", ariaLabel: t("Show {0}", title) });
  const opacity = make("input", {
    type: "range",
    min: "5",
    max: "100",
    step: "1",
    ariaLabel: t("Opacity of {0}", title),
  });
  visible.onchange = () => layerStyles.change(layer, { visible: visible.checked });
  opacity.oninput = () => layerStyles.change(layer, { opacity: opacity.valueAsNumber / 100, visible: true });
  layerStyles.all.subscribe(() => {
    const style = layerStyles.get(layer);
    if (style === undefined) return;
    visible.checked = style.visible;
    opacity.value = String(Math.round(100 * style.opacity));
    opacity.setAttribute("aria-valuetext", `${opacity.value} %`);
    opacity.style.setProperty("--filled", `${((100 * style.opacity - 5) / 95) * 100}%`);
  });
  const name = make("label", { className: "layer-name" }, visible, swatch, make("span", {}, title));
  return make("div", { className: "layer-row" }, name, opacity);
}
