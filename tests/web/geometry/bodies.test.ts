import { create } from "@bufbuild/protobuf";
import { describe, expect, test } from "vitest";
import { GetGeometryResponseSchema, Placement } from "../../../web/src/gen/phrenic/v1/frames_pb";
import { decodeBody, floatsPerPose, type FrameArrays, positionsOf, vertexAt } from "../../../web/src/geometry/bodies";
import { floats, indices } from "../../../web/src/geometry/wire_arrays";
import { bytesOf, triangleBody } from "../fakes/fake_server";

describe("numbers on the wire", () => {
  test("FloatsAreLittleEndian", () => {
    expect([...floats(new Uint8Array([0, 0, 128, 63, 0, 0, 0, 192]), 1, "x")]).toEqual([1, -2]);
  });

  test("BytesNeedNotBeAligned", () => {
    const bytes = new Uint8Array([99, 0, 0, 128, 63]).subarray(1);
    expect([...floats(bytes, 1, "x")]).toEqual([1]);
  });

  test("AnIncompleteGroupIsRefusedByName", () => {
    expect(() => floats(new Uint8Array(16), 3, "positions")).toThrow("positions: 16 bytes are not a multiple of 12");
  });

  test("AnIndexPastTheEndIsRefusedByName", () => {
    const bytes = bytesOf(new Uint32Array([0, 1, 3]));
    expect(() => indices(bytes, 3, 3, "cube.triangles")).toThrow(
      "cube.triangles: index 3 at 2, but there are 3 vertices",
    );
  });
});

describe("a vertex in a frame", () => {
  const frame = (fields: { positions?: Uint8Array; poses?: Uint8Array }): FrameArrays => ({
    positions: floats(fields.positions ?? new Uint8Array(), 3, "positions"),
    poses: floats(fields.poses ?? new Uint8Array(), floatsPerPose, "poses"),
  });

  test("OfAStreamedBodyIsReadFromThePositions", () => {
    const body = decodeBody(triangleBody({ placement: Placement.STREAMED, firstVertex: 1 }));
    const positions = bytesOf(new Float32Array([9, 9, 9, 1, 2, 3, 4, 5, 6, 7, 8, 9]));
    expect(vertexAt(body, frame({ positions }), 1)).toEqual([4, 5, 6]);
  });

  test("OfARigidBodyIsItsTransformedRestPosition", () => {
    const body = decodeBody(triangleBody({ placement: Placement.RIGID, pose: 1 }));
    const half = Math.SQRT1_2;
    // A quarter turn about +z, then 10 m along +x: (1, 0, 0) maps to (10, 1, 0).
    const poses = bytesOf(new Float32Array([0, 0, 0, 1, 0, 0, 0, 0, 0, half, half, 10, 0, 0]));
    const [x, y, z] = vertexAt(body, frame({ poses }), 1);
    expect([x, y, z].map((value) => Math.round(1e6 * value) / 1e6)).toEqual([10, 1, 0]);
  });

  test("OfAStillBodyIsItsRestPosition", () => {
    const body = decodeBody(triangleBody({ placement: Placement.STILL }));
    expect(vertexAt(body, frame({}), 2)).toEqual([0, 1, 0]);
  });

  test("IsRefusedIfTheFrameIsTooShort", () => {
    const body = decodeBody(triangleBody({ placement: Placement.STREAMED }));
    expect(() => positionsOf(body, frame({ positions: new Uint8Array(12) }))).toThrow(
      "before the vertices of triangle",
    );
  });
});

describe("a body", () => {
  test("WithoutALayerHasItsOwn", () => {
    const body = decodeBody(create(GetGeometryResponseSchema, { name: "sheet" }));
    expect([body.layer, body.layerTitle]).toEqual(["sheet", "sheet"]);
  });

  test("WithAnActionLineWithoutADirectionIsRefused", () => {
    const message = triangleBody({
      actionLines: [{ name: "a", origin: [0, 0, 0], direction: [] }],
    });
    expect(() => decodeBody(message)).toThrow("action_lines.direction: 0 numbers instead of 3");
  });
});
