import { create, toBinary } from "@bufbuild/protobuf";
import { beforeEach, describe, expect, test, vi } from "vitest";
import { FilmMaker, type PictureWriter } from "../../../web/src/film/film_maker";
import { recordedMotion } from "../../../web/src/film/recorded_motion";
import type { FilmStage } from "../../../web/src/film/pictures";
import type { DisplayedFrame } from "../../../web/src/frames/frame_buffer";
import { Codec, FrameSchema, GetGeometryResponseSchema, Placement } from "../../../web/src/gen/phrenic/v1/frames_pb";
import { OfflineMotionSchema } from "../../../web/src/gen/phrenic/v1/offline_pb";
import { filmRow } from "../../../web/src/panels/jobs/take_home";
import type { ExportProgress, Exports } from "../../../web/src/session/exports";
import { Signal } from "../../../web/src/state/signal";
import { decoderModule } from "../fakes/decoder_module";
import { bytesOf } from "../fakes/fake_server";
import { stored } from "../fakes/stored";

const point = create(GetGeometryResponseSchema, {
  name: "point",
  placement: Placement.STREAMED,
  restPositions: bytesOf(Float32Array.from([0, 0, 0])),
});
/** A point that rises by 1 m/s from the time 3 s on. */
const frames = [0, 0.5, 1].map((time) =>
  create(FrameSchema, {
    time: 3 + time,
    codec: Codec.RAW,
    bodies: [0],
    positions: bytesOf(Float32Array.from([0, 0, time])),
  }),
);
const motion = create(OfflineMotionSchema, { scene: "thorax", sceneTitle: "Thorax", bodies: [point], frames });
const text = Buffer.from(stored(toBinary(OfflineMotionSchema, motion))).toString("base64");

let page: string | undefined, refusal: string | undefined, supported: boolean;
let drawn: DisplayedFrame[], written: string[], words: string[], ends: number, begins: number;
let afterAdd: () => void;
let opened: HTMLCanvasElement;

class FakeExports {
  readonly progress = new Signal<ExportProgress>({ kind: "idle" });
  choices = {};
  choose(choices: object): void {
    this.choices = choices;
  }
  async start() {
    this.progress.set({ kind: "recording", file: "", done: 0.5, secondsLeft: 2 });
    if (page === undefined) this.progress.set({ kind: "failed", message: "the disk is full" });
    return page === undefined ? undefined : new Blob([page]);
  }
  stop(): void {
    this.progress.set({ kind: "idle" });
  }
}

const stage: FilmStage = {
  background: "#000",
  refusal: () => refusal,
  colors: () => undefined,
  area: () => ({ x: 10, y: 20, width: 300, height: 200 }),
  begin: () => begins++,
  draw: (frame) => {
    drawn.push({ time: frame.time, arrays: { ...frame.arrays, positions: frame.arrays.positions.slice() } });
    return document.createElement("canvas");
  },
  end: () => ends++,
};

const writer: PictureWriter = {
  add: async () => {
    written.push(words.splice(0).join("|"));
    afterAdd();
  },
  finish: async () => new Blob(["film"]),
  cancel: () => undefined,
};

function maker(): { film: FilmMaker; exports: FakeExports } {
  const exports = new FakeExports();
  const film = new FilmMaker(
    recordedMotion(
      exports as unknown as Exports,
      () => ["sheet", "rib"],
      async () => decoderModule(),
    ),
    stage,
    async (canvas) => {
      opened = canvas;
      return writer;
    },
    () => supported,
  );
  return { film, exports };
}

beforeEach(() => {
  page = `<script type="text/plain" id="motion">${text}</script>`;
  [refusal, supported, drawn, written, words, ends, begins] = [undefined, true, [], [], [], 0, 0];
  afterAdd = () => undefined;
  URL.createObjectURL = () => "blob:film";
  URL.revokeObjectURL = () => undefined;
  const pen = { save: () => 0, restore: () => 0, translate: () => 0, scale: () => 0, fillRect: () => 0, drawImage: () => 0, measureText: () => ({ width: 1 }), fillText: (each: string) => words.push(each) }; // prettier-ignore
  vi.spyOn(HTMLCanvasElement.prototype, "getContext").mockReturnValue(
    pen as unknown as CanvasRenderingContext2D & null,
  );
});

describe("a film", () => {
  test("HasTheSimulationsFramesAtAFixedRate", async () => {
    const { film, exports } = maker();
    await film.start();
    expect(exports.choices).toMatchObject({ format: "html", seconds: 0, bodies: ["sheet", "rib"] });
    expect(film.progress.value).toMatchObject({ kind: "ready", file: "thorax.webm", size: 4 });
    expect(drawn.length).toBe(25);
    drawn.forEach(({ time, arrays }, i) => {
      expect(time).toBeCloseTo(3 + i / 25, 6);
      expect(arrays.positions[2]).toBeCloseTo(i / 25, 5);
    });
    expect([begins, ends]).toEqual([1, 1]);
  });

  test("SaysSceneAndTimeInEachPicture", async () => {
    const { film } = maker();
    await film.start();
    expect(written[0]).toContain("Thorax|0.00 s");
    expect(written[24]).toContain("Thorax|0.96 s");
    expect(written.every((each) => each.includes("not for clinical use"))).toBe(true);
  });

  test("IsCancelledAndTheViewIsLiveAgain", async () => {
    const { film } = maker();
    afterAdd = () => drawn.length === 5 && film.stop();
    await film.start();
    expect(drawn.length).toBe(5);
    expect(ends).toBe(1);
    expect(film.progress.value.kind).toBe("idle");
  });

  test("IsRefusedWithoutWebCodecsBeforeTheServerRecords", async () => {
    supported = false;
    const { film } = maker();
    await film.start();
    expect(film.progress.value).toMatchObject({ kind: "failed", message: expect.stringContaining("WebCodecs") });
    expect(begins).toBe(0);
  });

  test.each([
    [() => (refusal = "It has no forces."), "It has no forces."],
    [() => (page = undefined), "the disk is full"],
    [() => (page = "<html></html>"), "The film cannot be made: motion: the exported page has no motion."],
    [() => (afterAdd = () => { throw new Error("no memory"); }), "no memory"], // prettier-ignore
  ])("ThatFailsSaysWhy", async (spoil, reason) => {
    spoil();
    const { film } = maker();
    await film.start();
    expect(film.progress.value).toMatchObject({ kind: "failed", message: expect.stringContaining(reason) });
    expect(ends).toBe(begins);
  });
});

test("AFilmHasTheHeightThatIsChosen", async () => {
  const { film } = maker();
  document.body.replaceChildren(filmRow(film));
  const lines = document.getElementById("film-lines") as HTMLSelectElement;
  const heights: number[] = [];
  afterAdd = () => void heights.push(opened.height);
  for (const chosen of ["720", "360", "1080"]) {
    if (chosen !== lines.value) lines.value = chosen;
    lines.dispatchEvent(new Event("change"));
    heights.length = 0;
    await film.start();
    expect(heights[0]).toBe(Number(chosen));
  }
});

test("TheFocusFollowsFromTheButtonToStopAndToTheFile", async () => {
  const progress = new Signal<ExportProgress>({ kind: "idle" });
  const start = async () => undefined;
  const stop = () => progress.set({ kind: "idle" });
  document.body.replaceChildren(filmRow({ progress, start, stop, lines: 720, choices: [720] }));
  const button = document.getElementById("film") as HTMLButtonElement;
  button.focus();
  progress.set({ kind: "recording", file: "", done: 0, secondsLeft: 1 });
  const focused = document.activeElement;
  expect(focused?.textContent).toBe("Stop");
  progress.set({ kind: "filming", file: "", done: 0.5 });
  expect(document.activeElement).toBe(focused);
  progress.set({ kind: "ready", file: "a.webm", size: 1e6, url: "blob:a" });
  expect(document.activeElement?.id).toBe("film-link");
});
