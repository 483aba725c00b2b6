import { create } from "@bufbuild/protobuf";
import { expect, test } from "vitest";
import { ImmediateDecoding } from "../../../../web/src/decoders/decoding";
import { decoderModule } from "../../fakes/decoder_module";
import { FrameBuffer } from "../../../../web/src/frames/frame_buffer";
import { FrameSchema } from "../../../../web/src/gen/phrenic/v1/frames_pb";
import { projectorRow } from "../../../../web/src/panels/view/projector_row";
import { Timeline } from "../../../../web/src/panels/view/timeline";

function watched() {
  const frames = new FrameBuffer(new ImmediateDecoding(decoderModule()), () => {});
  const timeline = new Timeline(frames, (time) => frames.replayAt(time));
  for (const time of [0, 1, 2]) frames.receive(create(FrameSchema, { time }), 1000 * time);
  timeline.show();
  const words = () => timeline.element.querySelector("output")!.textContent;
  return { frames, timeline, words, slider: timeline.element.querySelector("input")! };
}

test("TheSliderReplaysAndShowsTheAge", () => {
  const { frames, words, slider } = watched();
  expect(words()).toBe("live");
  slider.value = "1";
  slider.dispatchEvent(new Event("input"));
  expect(frames.replayedFrame?.time).toBe(1);
  expect(words()).toBe("1.00 s ago");
  expect(slider.getAttribute("aria-valuetext")).toBe("1.00 s ago");
});

test("SteppingGoesBackAndForwardToLive", () => {
  const { frames, timeline } = watched();
  timeline.stepFrame(1);
  expect(timeline.replaying).toBe(false);
  timeline.stepFrame(-1);
  expect(frames.replayedFrame?.time).toBe(1);
  timeline.stepFrame(1);
  expect(timeline.replaying).toBe(false);
});

test("TheProjectorModeIsStored", () => {
  const kept = new Map<string, string>();
  const memory = {
    getItem: (key: string) => kept.get(key) ?? null,
    setItem: (key: string, value: string) => void kept.set(key, value),
  };
  const input = projectorRow(memory).querySelector("input")!;
  expect(document.documentElement.classList.contains("projector")).toBe(false);
  input.checked = true;
  input.dispatchEvent(new Event("change"));
  expect(document.documentElement.classList.contains("projector")).toBe(true);
  expect(projectorRow(memory).querySelector("input")!.checked).toBe(true);
});
