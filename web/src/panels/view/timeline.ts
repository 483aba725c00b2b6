import { button, make } from "../../dom/elements";
import { icon } from "../../dom/icons";
import type { FrameBuffer } from "../../frames/frame_buffer";

/** Less than this is not worth looking back on [s]. */
const minSpan = 0.5;

/** The last seconds as a slider: the picture stands where it is put, while the simulation does what it does. */
export class Timeline {
  readonly element = make("div", { id: "timeline" });
  private readonly slider = make("input", { type: "range", id: "look-back", step: "any", ariaLabel: "Look back" });
  private readonly words = make("output");
  private readonly live: HTMLButtonElement;

  constructor(
    private readonly frames: FrameBuffer,
    private readonly onReplay: (time: number | undefined) => void,
  ) {
    this.slider.title = "Look back at the last seconds";
    this.slider.oninput = () => this.replayAt(this.slider.valueAsNumber);
    this.live = button("Back to the present", () => this.replayAt(Infinity), icon("play"));
    this.live.id = "look-live";
    this.live.className = "quiet";
    this.element.append(this.slider, this.words, this.live);
  }

  /** One frame earlier, or later. */
  stepFrame(by: -1 | 1): void {
    const { replayedFrame } = this.frames;
    if (by > 0 && replayedFrame === undefined) return;
    this.replayAt(this.frames.adjacentTime(by) ?? Infinity);
  }

  get replaying(): boolean {
    return this.frames.replayedFrame !== undefined;
  }

  show(): void {
    const { span, replayedFrame } = this.frames;
    this.slider.disabled = span.end - span.start < minSpan;
    // Where there is nothing to look back on, the knob stands at the end.
    [this.slider.min, this.slider.max] = [String(Math.min(span.start, span.end - minSpan)), String(span.end)];
    const ago = replayedFrame === undefined ? 0 : span.end - replayedFrame.time;
    if (document.activeElement !== this.slider || replayedFrame === undefined)
      this.slider.value = String(span.end - ago);
    const words = replayedFrame === undefined ? "now" : `${ago.toFixed(2)} s ago`;
    if (this.words.textContent !== words) this.words.textContent = words;
    this.slider.setAttribute("aria-valuetext", words);
    const part = span.end > span.start ? 1 - ago / (span.end - span.start) : 1;
    this.slider.style.setProperty("--filled", `${100 * part}%`);
    this.element.classList.toggle("back", replayedFrame !== undefined);
    this.live.disabled = replayedFrame === undefined;
  }

  private replayAt(time: number): void {
    this.onReplay(time < this.frames.span.end ? time : undefined);
    this.show();
  }
}
