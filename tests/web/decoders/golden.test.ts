import { fromBinary, toBinary } from "@bufbuild/protobuf";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { expect, test } from "vitest";
import { FrameDecoder } from "../../../web/src/decoders/frame_decoder";
import {
  type Frame,
  GetGeometryResponseSchema,
  Placement,
  WatchFramesResponseSchema,
} from "../../../web/src/gen/phrenic/v1/frames_pb";
import { decodeBody } from "../../../web/src/geometry/bodies";

import { decoderModule } from "../fakes/decoder_module";
import { triangleBody } from "../fakes/fake_server";

// The server's tests pin the same files: tests/golden/frame_test.cc.
const golden = join(import.meta.dirname, "../../golden");
const bytes = (name: string) =>
  new Uint8Array(Buffer.from(readFileSync(join(golden, name), "utf8").replace(/\s/g, ""), "hex"));
const json = (name: string) => JSON.parse(readFileSync(join(golden, name), "utf8"));

function frameInTheFile(): Frame {
  const { event } = fromBinary(WatchFramesResponseSchema, bytes("frame.hex"));
  if (event.case !== "frame") throw new Error("tests/golden/frame.hex holds no frame.");
  return event.value;
}

test("GoldenFrameDecodes", () => {
  const frame = frameInTheFile();
  const scene = [triangleBody({ placement: Placement.STILL }), triangleBody({})].map(decodeBody);
  const { positions, poses } = new FrameDecoder(decoderModule(), scene).decode(frame);
  expect({
    sequence: Number(frame.sequence),
    tick: Number(frame.tick),
    time: frame.time,
    breath: frame.breath,
    phase: frame.phase,
    unixNanos: String(frame.unixNanos),
    positions: [...positions],
    poses: [...poses],
    probes: frame.probes.map(({ name, x, y, z, dx, dy, dz }) => ({ name, x, y, z, dx, dy, dz })),
    measures: frame.measures.map(({ name, value, unit }) => ({ name, value, unit })),
  }).toEqual(json("frame.json"));
});

test("GoldenGeometryDecodes", () => {
  const message = fromBinary(GetGeometryResponseSchema, bytes("geometry.hex"));
  const body = decodeBody(message);
  const { name, layer, layerTitle, color, opacity, placement, pose, firstVertex } = body;
  expect({
    bodyCount: message.bodyCount,
    bodyIndex: message.bodyIndex,
    ...{ name, layer, layerTitle, color, opacity, placement, pose, firstVertex },
    restPositions: [...body.rest],
    triangles: [...body.triangles],
    fixedVertices: [...body.fixed],
  }).toEqual(json("geometry.json"));
});

test("GoldenBytesHaveNoUnknownFields", () => {
  for (const [name, schema] of [
    ["frame.hex", WatchFramesResponseSchema],
    ["geometry.hex", GetGeometryResponseSchema],
  ] as const) {
    const message = fromBinary(schema, bytes(name));
    expect(message.$unknown).toBeUndefined();
    expect(toBinary(schema, message)).toEqual(bytes(name));
  }
});
