import { create, toBinary } from "@bufbuild/protobuf";
import { describe, expect, test } from "vitest";
import { Codec, FrameSchema, GetGeometryResponseSchema, Placement } from "../../../web/src/gen/phrenic/v1/frames_pb";
import { type OfflineMotion, OfflineMotionSchema } from "../../../web/src/gen/phrenic/v1/offline_pb";
import { Clip, motionText, readMotion } from "../../../web/src/frames/clip";
import { factsSection } from "../../../web/src/offline/facts";
import { playback, scrubber } from "../../../web/src/offline/playback";
import { Player } from "../../../web/src/offline/player";
import { motionTitle } from "../../../web/src/parameters/presets";
import { decoderModule } from "../fakes/decoder_module";
import { bytesOf } from "../fakes/fake_server";
import { stored } from "../fakes/stored";

const triangle = create(GetGeometryResponseSchema, {
  name: "sheet",
  placement: Placement.STREAMED,
  restPositions: bytesOf(Float32Array.from([0, 0, 0, 1, 0, 0, 0, 1, 0])),
  triangles: bytesOf(Uint32Array.from([0, 1, 2])),
});

/** A frame of the triangle, raised by `height` [m]. */
const frame = (time: number, height: number) =>
  create(FrameSchema, {
    time,
    codec: Codec.RAW,
    bodies: [0],
    positions: bytesOf(Float32Array.from([0, 0, height, 1, 0, height, 0, 1, height])),
  });

const motion = create(OfflineMotionSchema, {
  scene: "thorax",
  sceneTitle: "A breathing thorax",
  parameters: { breathLength: 4, breathForce: 2 },
  sceneParameters: { breathLength: 4, breathForce: 1 },
  presets: [{ name: "deep", title: "Deep", description: "Everything pulls.", parameters: { breathForce: 2 } }],
  bodies: [triangle],
  frames: [frame(3, 0), frame(4, 1), frame(5, 3)],
});

const textOf = (of: OfflineMotion) => Buffer.from(stored(toBinary(OfflineMotionSchema, of))).toString("base64");

describe("the text of a page", () => {
  test("IsReadBack", () => {
    const read = readMotion(decoderModule(), `\n      ${textOf(motion)}\n`);
    expect(read.scene).toBe("thorax");
    expect(read.frames.length).toBe(3);
  });

  test("IsFoundInThePage", () => {
    expect(motionText('<body><script type="text/plain" id="motion">\nabc=\n</script></body>').trim()).toBe("abc=");
    expect(() => motionText("<body></body>")).toThrow(RangeError);
  });

  test.each([
    ["__PHRENIC_MOTION__", "not Base64"],
    [textOf(motion).slice(0, 40), "zstd"],
    [textOf(create(OfflineMotionSchema, { scene: "x" })), "frames"],
  ])("ThatIsDamagedThrowsRangeError", (text, reason) => {
    expect(() => readMotion(decoderModule(), text)).toThrow(RangeError);
    expect(() => readMotion(decoderModule(), text)).toThrow(reason);
  });
});

describe("a clip", () => {
  const clip = new Clip(decoderModule(), motion.frames, motion.bodies);

  test("BeginsAtItsFirstFrame", () => {
    expect(clip.times).toEqual([0, 1, 2]);
    expect(clip.length).toBe(2);
    expect(clip.at(0).positions[2]).toBe(0);
  });

  test("InterpolatesBetweenFrames", () => {
    expect(clip.at(0.5).positions[2]).toBeCloseTo(0.5, 6);
    expect(clip.at(1.5).positions[2]).toBeCloseTo(2, 6);
    expect(clip.at(2).positions[2]).toBe(3);
    expect([clip.indexAt(0), clip.indexAt(0.99), clip.indexAt(1), clip.indexAt(2)]).toEqual([0, 0, 1, 2]);
  });

  test("GivesTheSameObjectAtTheSameTime", () => {
    const once = clip.at(0.7);
    expect(clip.at(0.7)).toBe(once);
    expect(clip.at(0.8)).not.toBe(once);
  });
});

describe("the player", () => {
  test("StartsAgainAtTheEnd", () => {
    const player = new Player(4);
    player.setPlaying(true);
    expect(player.advance(1000)).toBe(false);
    expect(player.advance(2500)).toBe(true);
    expect(player.time.value).toBeCloseTo(1.5, 9);
    player.speed = 2;
    player.advance(4000);
    expect(player.time.value).toBeCloseTo(0.5, 9);
  });

  test("LosesNoTimeToAPause", () => {
    const player = new Player(4);
    player.setPlaying(true);
    player.advance(0);
    player.advance(500);
    player.setPlaying(false);
    expect(player.advance(9000)).toBe(false);
    player.setPlaying(true);
    player.advance(10_000);
    player.advance(10_100);
    expect(player.time.value).toBeCloseTo(0.6, 9);
  });

  test("DoesNotPlayASingleFrame", () => {
    const player = new Player(0);
    player.setPlaying(true);
    expect(player.playing.value).toBe(false);
  });
});

test("TheControlsPlayPauseAndScrub", () => {
  const player = new Player(4);
  document.body.replaceChildren(playback(player), scrubber(player, 4));
  const toggle = document.getElementById("play") as HTMLButtonElement;
  const slider = document.getElementById("scrub") as HTMLInputElement;
  toggle.click();
  expect(player.playing.value).toBe(true);
  expect(toggle.ariaLabel).toBe("Pause");
  slider.value = "1.5";
  slider.dispatchEvent(new Event("input"));
  expect([player.playing.value, player.time.value]).toEqual([false, 1.5]);
  expect(slider.getAttribute("aria-valuetext")).toBe("1.50 of 4.00 s");
  slider.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowRight" }));
  expect(player.time.value).toBeCloseTo(1.58, 9);
});

test("TheFactsNameSceneBreathAndParameters", () => {
  expect(motionTitle(motion)).toEqual({ scene: "A breathing thorax", preset: "Deep" });
  const text = factsSection(motion).textContent ?? "";
  expect(text).toContain("A breathing thorax (thorax)");
  expect(text).toContain("Deep. Everything pulls.");
  expect(text).toMatch(/Breath force 2 instead of 1/i);
  expect(text).not.toMatch(/undefined|NaN/);
});
