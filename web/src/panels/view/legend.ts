import type { ColorScale } from "../../appearance/color_scale";
import { make } from "../../dom/elements";
import { decimal, t } from "../../language/translate";

/** The colours of a scale with its ticks. */
export class Legend {
  readonly element: HTMLElement;
  private readonly bar = make("canvas", { width: 256, height: 1, role: "img" });
  private readonly unit = make("span");
  private readonly ticks = make("div", { className: "legend-ticks", ariaHidden: "true" });

  constructor() {
    this.element = make("div", { className: "legend" }, this.bar, this.unit, this.ticks);
  }

  /** Shows a scale. */
  show(scale: ColorScale): void {
    this.bar.ariaLabel = t("Colours from {0} to {1} {2}", scale.low, scale.top, scale.unit);
    this.unit.textContent = scale.unit;
    this.draw(scale);
    this.ticks.replaceChildren(
      ...scale.ticks().map(({ fraction, text }) => {
        const tick = make("span", {}, decimal(text));
        tick.style.left = `${100 * fraction}%`;
        return tick;
      }),
    );
  }

  private draw(scale: ColorScale): void {
    const pen = this.bar.getContext("2d");
    if (!pen) return;
    const { width } = this.bar;
    for (let x = 0; x < width; x++) {
      pen.fillStyle = `rgb(${scale.color(scale.low + (x / (width - 1)) * (scale.top - scale.low)).join(" ")})`;
      pen.fillRect(x, 0, 1, 1);
    }
  }
}
