import { create } from "@bufbuild/protobuf";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { describe, expect, test, vi } from "vitest";
import { FrameDecoder } from "../../../web/src/decoders/frame_decoder";
import {
  Codec,
  FrameSchema,
  GetBasisResponseSchema,
  GetGeometryResponseSchema,
  Placement,
} from "../../../web/src/gen/phrenic/v1/frames_pb";
import type { Body } from "../../../web/src/geometry/bodies";
import { decodeBody } from "../../../web/src/geometry/bodies";
import { decoderModule, decoderModules } from "../fakes/decoder_module";
import { bytesOf, triangleBody } from "../fakes/fake_server";

interface Golden {
  rest: number[];
  triangles: number[];
  shapes: { bytes: string; displacements: number[] }[];
  encodings: { codec: keyof typeof Codec; bytes: string; positions: number[] }[];
}

// The server's tests pin the same file: tests/golden/codecs_test.cc.
const golden = JSON.parse(readFileSync(join(import.meta.dirname, "../../golden/codecs.json"), "utf8")) as Golden;
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

const basis = create(GetBasisResponseSchema, { epoch: 1n, shapes: golden.shapes.map(({ bytes }) => bytesIn(bytes)) });

/** Returns a function that decodes positions of the sheet, always with the same decoder. */
function decodeWith(module: WebAssembly.Module, codec: Codec) {
  const decoder = new FrameDecoder(module, [sheet]);
  decoder.addBasis(basis);
  const basisEpoch = codec === Codec.BASIS ? 1n : 0n;
  return (positions: Uint8Array) =>
    decoder.decode(create(FrameSchema, { codec, positions, bodies: [0], basisEpoch })).positions;
}

const cases = [...decoderModules].flatMap(([build, module]) =>
  golden.encodings.map((encoding) => ({ build, module, ...encoding })),
);

describe.each(cases)("$codec by $build", ({ module, codec, bytes, positions }) => {
  test("PositionsAreThoseInTheFileBitForBit", () => {
    expect([...decodeWith(module, codecOf(codec))(bytesIn(bytes))]).toEqual([...Float32Array.from(positions)]);
  });

  test("InvalidBytesThrowRangeError", () => {
    const whole = bytesIn(bytes);
    const decode = decodeWith(module, codecOf(codec));
    const outcome = (changed: Uint8Array) => {
      try {
        return decode(changed).length;
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
    expect([...decode(whole)]).toEqual([...Float32Array.from(positions)]);
  });
});

test("TheFileContainsEveryCodec", () => {
  const named = golden.encodings.map(({ codec }) => codecOf(codec));
  expect([...new Set(named)].sort()).toEqual([Codec.RAW, Codec.PLANES, Codec.PREDICTED, Codec.BASIS]);
});

test("ShapesAreThoseInTheFileBitForBit", () => {
  const shapes = golden.shapes.map(({ bytes }) =>
    decodeWith(decoderModule(), Codec.PREDICTED)(bytesIn(bytes)).map((x, i) => x - sheet.rest[i]),
  );
  expect(shapes.map((each) => [...each])).toEqual(
    golden.shapes.map(({ displacements }) => [...Float32Array.from(displacements)]),
  );
});

test("AFrameOfAnUnknownBasisIsRefused", () => {
  const frame = create(FrameSchema, { codec: Codec.BASIS, bodies: [0], basisEpoch: 2n });
  expect(() => new FrameDecoder(decoderModule(), [sheet]).decode(frame)).toThrow(
    "basis_epoch: the basis of epoch 2 has not been received",
  );
});

/** CODEC_PREDICTED of two triangles, all vertices 1 m above rest: only the residual of the first vertex is not zero. */
function allUp(): Uint8Array {
  const pairs = [0, 0, 0, 2, 0]; // of 18 numbers the 13th is 1
  const frame = [0x28, 0xb5, 0x2f, 0xfd, 0x20, pairs.length, (pairs.length << 3) | 1, 0, 0, ...pairs];
  const head = new DataView(new ArrayBuffer(16));
  head.setFloat64(0, 1, true);
  head.setUint32(8, frame.length, true);
  return Uint8Array.from([...new Uint8Array(head.buffer), ...frame]);
}

test("ABodyUsesItsPartOfTheBasis", () => {
  const [one, other] = [0, 3].map((firstVertex) =>
    decodeBody(triangleBody({ placement: Placement.STREAMED, firstVertex })),
  );
  const decoder = new FrameDecoder(decoderModule(), [one, other]);
  decoder.addBasis(create(GetBasisResponseSchema, { epoch: 3n, shapes: [allUp()] }));
  const head = new DataView(new ArrayBuffer(20));
  head.setFloat64(0, 1, true);
  head.setUint32(8, 1, true);
  head.setFloat32(16, 2, true);
  const positions = new Uint8Array(head.buffer);
  const frame = create(FrameSchema, { codec: Codec.BASIS, bodies: [1], basisEpoch: 3n, positions });
  const raised = [...other.rest].map((x, i) => (i % 3 === 2 ? x + 2 : x));
  expect([...decoder.decode(frame).positions]).toEqual([...one.rest, ...raised]);
});

test("BodiesMissingInAFrameStayAtRest", () => {
  const one = decodeBody(triangleBody({ placement: Placement.STREAMED, firstVertex: 0 }));
  const other = decodeBody(triangleBody({ placement: Placement.STREAMED, firstVertex: 3 }));
  const moved = bytesOf(new Float32Array([9, 9, 9, 8, 8, 8, 7, 7, 7]));
  const frame = create(FrameSchema, { codec: Codec.RAW, positions: moved, bodies: [1] });
  const { positions } = new FrameDecoder(decoderModule(), [one, other]).decode(frame);
  expect([...positions]).toEqual([...one.rest, 9, 9, 9, 8, 8, 8, 7, 7, 7]);
});

test("AnUnknownBodyIsRefused", () => {
  expect(() => new FrameDecoder(decoderModule(), []).decode(create(FrameSchema, { bodies: [3] }))).toThrow(
    "bodies: an index is out of range, there are 0 bodies",
  );
});

test("OnlyTheDecodersOfTheLastThreeSetsOfBodiesAreKept", () => {
  const bodies = [0, 3, 6, 9].map((firstVertex) =>
    decodeBody(triangleBody({ placement: Placement.STREAMED, firstVertex })),
  );
  const decoder = new FrameDecoder(decoderModule(), bodies);
  const { Instance } = WebAssembly;
  const made = vi.spyOn(WebAssembly, "Instance").mockImplementation(function (module) {
    return new Instance(module);
  });
  const madeFor = (body: number) => {
    const before = made.mock.calls.length;
    decoder.decode(create(FrameSchema, { codec: Codec.RAW, positions: new Uint8Array(36), bodies: [body] }));
    return made.mock.calls.length - before;
  };
  expect([0, 1, 2, 0, 3].map(madeFor)).toEqual([1, 1, 1, 0, 1]);
  expect([0, 2, 3, 1].map(madeFor)).toEqual([0, 0, 0, 1]);
  made.mockRestore();
});
