import { expect, test } from "vitest";
import { TrackedVertices } from "../../../web/src/appearance/tracked_vertices";
import { decodeBody } from "../../../web/src/geometry/bodies";
import { triangleBody } from "../fakes/fake_server";

const body = decodeBody(triangleBody({}));
const raised = (up: number) => ({
  positions: body.rest.map((value, i) => (i % 3 === 2 ? value + up : value)),
  poses: new Float32Array(),
});

test("ATrackedVertexIsMarkedPlottedAndUntracked", () => {
  const trackedVertices = new TrackedVertices(() => [body]);
  const ref = { body: "triangle", vertex: 1 };
  trackedVertices.picked.set(ref);
  expect(trackedVertices.markers(raised(0))).toMatchObject([{ position: [1, 0, 0], color: "#ffffff" }]);
  trackedVertices.track(ref);
  trackedVertices.track(ref);
  expect(trackedVertices.tracked.value).toEqual([ref]);
  expect(trackedVertices.spec!.curves.map(({ name }) => name)).toEqual(["triangle 1"]);
  for (const time of [0, 1, 2]) trackedVertices.receive(time, raised(0.25 * time));
  expect(trackedVertices.history.series.get("triangle 1")).toEqual([0, 0.25, 0.5]);
  expect(trackedVertices.stateOf(ref, raised(0.5))).toEqual({ position: [1, 0, 0.5], displacement: [0, 0, 0.5] });
  trackedVertices.untrack(ref);
  expect([trackedVertices.spec, trackedVertices.tracked.value.length]).toEqual([undefined, 0]);
});
