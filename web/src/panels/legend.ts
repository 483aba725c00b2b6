import type { DistanceScale } from "../distance_scale";
import { make } from "./dom";

/** The colours of a scale beside their distances. */
export class Legend {
  readonly element: HTMLElement;
  private readonly bar = make("canvas", { width: 256, height: 1, role: "img" });
  private readonly ticks = make("div", { className: "legend-ticks", ariaHidden: "true" });

  constructor() {
    this.element = make("div", { className: "legend" }, this.bar, make("span", {}, "mm"), this.ticks);
  }

  show(scale: DistanceScale): void {
    this.bar.ariaLabel = `Colours from 0 to ${scale.top} mm`;
    this.draw(scale);
    this.ticks.replaceChildren(
      ...scale.ticks().map(({ part, text }) => {
        const tick = make("span", {}, text);
        tick.style.left = `${100 * part}%`;
        return tick;
      }),
    );
  }

  private draw(scale: DistanceScale): void {
    const pen = this.bar.getContext("2d");
    if (!pen) return;
    const { width } = this.bar;
    for (let x = 0; x < width; x++) {
      pen.fillStyle = `rgb(${scale.color((x / (width - 1)) * scale.top).join(" ")})`;
      pen.fillRect(x, 0, 1, 1);
    }
  }
}
