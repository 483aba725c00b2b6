import { create } from "@bufbuild/protobuf";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { describe, expect, test } from "vitest";
import type { Body } from "../../web/src/codec";
import { decodeBody } from "../../web/src/codec";
import { FrameDecoder } from "../../web/src/frame_decoder";
import { Codec, FrameSchema, GetGeometryResponseSchema, Placement } from "../../web/src/gen/phrenic/v1/frames_pb";
import { bytesOf, triangleBody } from "./fake_server";

interface Golden {
  rest: number[];
  triangles: number[];
  encodings: { codec: keyof typeof Codec; bytes: string; positions: number[] }[];
}

// The server's tests pin the same file: tests/golden/codecs_test.cc.
const golden = JSON.parse(readFileSync(join(import.meta.dirname, "../golden/codecs.json"), "utf8")) as Golden;
const codecOf = (name: string) => Codec[name.replace("CODEC_", "") as keyof typeof Codec];
const bytesIn = (hex: string) => new Uint8Array(Buffer.from(hex, "hex"));

const sheet: Body = decodeBody(
  create(GetGeometryResponseSchema, {
    name: "sheet",
    placement: Placement.STREAMED,
    restPositions: bytesOf(Float32Array.from(golden.rest)),
    triangles: bytesOf(Uint32Array.from(golden.triangles)),
  }),
);

const decode = (codec: Codec, positions: Uint8Array) =>
  new FrameDecoder([sheet]).decode(create(FrameSchema, { codec, positions, bodies: [0] })).positions;

describe.each(golden.encodings)("$codec", ({ codec, bytes, positions }) => {
  test("PositionsAreThoseInTheFileBitForBit", () => {
    expect([...decode(codecOf(codec), bytesIn(bytes))]).toEqual([...Float32Array.from(positions)]);
  });

  test("NoBytesDoHarm", () => {
    const whole = bytesIn(bytes);
    const outcome = (changed: Uint8Array) => {
      try {
        return decode(codecOf(codec), changed).length;
      } catch (error) {
        expect(error).toBeInstanceOf(RangeError);
        return 0;
      }
    };
    for (let i = 0; i < whole.length; i++) {
      expect(outcome(whole.slice(0, i))).toBe(0);
      for (const flip of [1, 0x80, 0xff]) {
        const flipped = whole.slice();
        flipped[i] ^= flip;
        expect([0, golden.rest.length]).toContain(outcome(flipped));
      }
    }
  });
});

test("EveryCodecOfTheWireIsInTheFile", () => {
  const named = golden.encodings.map(({ codec }) => codecOf(codec));
  expect(named.sort()).toEqual([Codec.RAW, Codec.PLANES, Codec.PREDICTED]);
});

test("BodiesThatAreNotInAFrameStayAtRest", () => {
  const one = decodeBody(triangleBody({ placement: Placement.STREAMED, firstVertex: 0 }));
  const other = decodeBody(triangleBody({ placement: Placement.STREAMED, firstVertex: 3 }));
  const moved = bytesOf(new Float32Array([9, 9, 9, 8, 8, 8, 7, 7, 7]));
  const frame = create(FrameSchema, { codec: Codec.RAW, positions: moved, bodies: [1] });
  const { positions } = new FrameDecoder([one, other]).decode(frame);
  expect([...positions]).toEqual([...one.rest, 9, 9, 9, 8, 8, 8, 7, 7, 7]);
});

test("ABodyThatIsNotInTheSceneIsRefused", () => {
  expect(() => new FrameDecoder([]).decode(create(FrameSchema, { bodies: [3] }))).toThrow("bodies: there are only 0");
});
