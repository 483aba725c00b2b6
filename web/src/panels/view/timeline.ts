import { button, make } from "../../dom/elements";
import { icon } from "../../dom/icons";
import type { FrameBuffer } from "../../frames/frame_buffer";
import { fixed, t } from "../../language/translate";

/** Shortest recording that can be replayed [s]. */
const minSpan = 0.5;

/** A slider over the last seconds that replays earlier frames while the simulation continues. */
export class Timeline {
  readonly element = make("div", { id: "timeline" });
  private readonly slider = make("input", { type: "range", id: "replay", step: "any", ariaLabel: t("Replay") });
  private readonly words = make("output");
  private readonly live: HTMLButtonElement;

  constructor(
    private readonly frames: FrameBuffer,
    private readonly onReplay: (time: number | undefined) => void,
  ) {
    this.slider.title = t("Replay the last seconds");
    this.slider.oninput = () => this.replayAt(this.slider.valueAsNumber);
    this.live = button(t("Back to live"), () => this.replayAt(Infinity), icon("play"));
    this.live.id = "replay-live";
    this.live.className = "quiet";
    this.element.append(this.slider, this.words, this.live);
  }

  /** Goes one frame back or forward. */
  stepFrame(by: -1 | 1): void {
    const { replayedFrame } = this.frames;
    if (by > 0 && replayedFrame === undefined) return;
    this.replayAt(this.frames.adjacentTime(by) ?? Infinity);
  }

  /** True if an earlier frame is displayed. */
  get replaying(): boolean {
    return this.frames.replayedFrame !== undefined;
  }

  /** Updates the slider to the recorded frames. */
  show(): void {
    const { span, replayedFrame } = this.frames;
    this.slider.disabled = span.end - span.start < minSpan;
    // Without a recording the slider is at its end.
    [this.slider.min, this.slider.max] = [String(Math.min(span.start, span.end - minSpan)), String(span.end)];
    const ago = replayedFrame === undefined ? 0 : span.end - replayedFrame.time;
    if (document.activeElement !== this.slider || replayedFrame === undefined)
      this.slider.value = String(span.end - ago);
    const words = replayedFrame === undefined ? t("live") : t("{0} s ago", fixed(ago, 2));
    if (this.words.textContent !== words) this.words.textContent = words;
    this.slider.setAttribute("aria-valuetext", words);
    const part = span.end > span.start ? 1 - ago / (span.end - span.start) : 1;
    this.slider.style.setProperty("--filled", `${100 * part}%`);
    this.element.classList.toggle("replaying", replayedFrame !== undefined);
    this.live.disabled = replayedFrame === undefined;
  }

  private replayAt(time: number): void {
    this.onReplay(time < this.frames.span.end ? time : undefined);
    this.show();
  }
}
