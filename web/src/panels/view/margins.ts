import { make } from "../../dom/elements";
import type { ViewOrientation } from "../../viewer/camera_rig";

const lengths = [0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50];
const longest = 120;

/** Anatomical letters at the edges of the view, and a scale bar. */
export class Margins {
  readonly elements: HTMLElement[];
  private readonly letters = {
    left: letter("left"),
    right: letter("right"),
    top: letter("top"),
    bottom: letter("bottom"),
  };
  private readonly bar = make("span", { className: "scale-bar" });
  private readonly words = make("span");

  constructor() {
    const scale = make("div", { className: "scale" }, this.bar, this.words);
    this.elements = [...Object.values(this.letters), scale];
  }

  /** Shows the orientation and scale of a view. */
  show(orientation: ViewOrientation): void {
    for (const side of ["left", "right", "top", "bottom"] as const) {
      if (this.letters[side].textContent !== orientation[side]) this.letters[side].textContent = orientation[side];
    }
    const length = lengths.findLast((each) => each * orientation.pixelsPerMetre <= longest) ?? lengths[0];
    this.bar.style.width = `${length * orientation.pixelsPerMetre}px`;
    const text = length < 1 ? `${Math.round(1000 * length)} mm` : `${length} m`;
    if (this.words.textContent !== text) this.words.textContent = text;
  }
}

function letter(side: string): HTMLElement {
  return make("span", { className: `letter ${side}` });
}
