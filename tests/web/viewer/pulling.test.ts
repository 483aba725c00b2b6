import { create } from "@bufbuild/protobuf";
import * as THREE from "three";
import { describe, expect, test } from "vitest";
import { SessionSchema } from "../../../web/src/gen/phrenic/v1/session_pb";
import { pullRow } from "../../../web/src/panels/parameters/pull_row";
import { SessionController } from "../../../web/src/session/session_controller";
import { dragPoint, pickVertex } from "../../../web/src/viewer/picking";
import { FakeClock, settle } from "../fakes/fake_clock";
import { FakeServer } from "../fakes/fake_server";

const camera = new THREE.PerspectiveCamera(30, 1);
camera.position.set(0, 0, 5);
camera.updateMatrixWorld();

/** A triangle around the z axis at this height; the camera looks down on it. */
const triangle = (z: number) => ({ positions: [-0.5, -0.5, z, 0.5, -0.5, z, 0, 0.5, z], triangles: [0, 1, 2] });
const pointAt = (x: number, y: number, z: number) => {
  const { x: right, y: up } = new THREE.Vector3(x, y, z).project(camera);
  return new THREE.Vector2(right, up);
};

describe("picking", () => {
  test("FindsTheNearestCornerOfTheFrontTriangle", () => {
    const picked = pickVertex(pointAt(0.3, -0.4, 1), camera, [triangle(0), triangle(1)]);
    expect(picked).toMatchObject({ body: 1, vertex: 1 });
    expect(picked!.position.toArray()).toEqual([0.5, -0.5, 1]);
  });

  test("FindsAVertexBesideTheSurface", () => {
    expect(pickVertex(pointAt(0, 0.53, 0), camera, [triangle(0)])).toMatchObject({ body: 0, vertex: 2 });
    expect(pickVertex(pointAt(-0.52, -0.5, 0), camera, [{ ...triangle(0), triangles: [] }])).toMatchObject({
      vertex: 0,
    });
  });

  test("FindsNothingFarAway", () => {
    expect(pickVertex(pointAt(0.9, 0.9, 0), camera, [triangle(0)])).toBeUndefined();
  });

  test("ADragMovesParallelToTheScreen", () => {
    const to = dragPoint(pointAt(0.2, 0.3, 1), camera, new THREE.Vector3(-0.5, 0.1, 1));
    expect(to.distanceTo(new THREE.Vector3(0.2, 0.3, 1))).toBeLessThan(1e-9);
  });
});

test("OnlyTheNewestPullOnAVertexIsSent", async () => {
  const server = new FakeServer();
  const clock = new FakeClock();
  const controller = new SessionController(server.api, "thorax", clock);
  controller.pull("sheet", 3, [1, 0, 0]);
  await settle();
  for (let i = 2; i <= 9; i++) controller.pull("sheet", 3, [i, 0, 0]);
  controller.pull("sheet", 4, [0, 0, 5]);
  await clock.advance(100);
  expect(server.pulls.map(({ vertex, force }) => [vertex, force?.x, force?.z])).toEqual([
    [3, 1, 0],
    [3, 9, 0],
    [4, 0, 5],
  ]);
});

test("PullsAreCounted", async () => {
  const controller = new SessionController(new FakeServer().api, "thorax", new FakeClock());
  const row = pullRow(controller);
  expect(row.hidden).toBe(true);
  const pull = { body: "sheet", vertex: 1, force: { x: 1 } };
  controller.receive(create(SessionSchema, { revision: 2n, pulls: [pull, pull] }));
  expect(row.hidden).toBe(false);
  expect(row.textContent).toContain("2 vertices are pulled");
});
