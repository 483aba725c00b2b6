import { expect, test } from "vitest";
import { Following } from "../../../web/src/appearance/tracked_vertices";
import { Expiration } from "../../../web/src/frames/end_expiration";
import { decodeBody } from "../../../web/src/geometry/bodies";
import { triangleBody } from "../fakes/fake_server";

const body = decodeBody(triangleBody({}));
const raised = (up: number) => ({
  positions: body.rest.map((value, i) => (i % 3 === 2 ? value + up : value)),
  poses: new Float32Array(),
});

test("AFollowedVertexIsMarkedDrawnAndLeft", () => {
  const following = new Following(() => [body]);
  const ref = { body: "triangle", vertex: 1 };
  following.picked.set(ref);
  expect(following.markers(raised(0))).toMatchObject([{ place: [1, 0, 0], color: "#ffffff" }]);
  following.follow(ref);
  following.follow(ref);
  expect(following.all.value).toEqual([ref]);
  expect(following.spec!.curves.map(({ name }) => name)).toEqual(["triangle 1"]);
  for (const time of [0, 1, 2]) following.receive(time, raised(0.25 * time));
  expect(following.history.series.get("triangle 1")).toEqual([0, 0.25, 0.5]);
  expect(following.standing(ref, raised(0.5))).toEqual({ place: [1, 0, 0.5], way: [0, 0, 0.5] });
  following.leave(ref);
  expect([following.spec, following.all.value.length]).toEqual([undefined, 0]);
});

test("ExpirationEndsWhereTheBreathTurnsUpwards", () => {
  const expiration = new Expiration();
  const breath = [0, 0.5, 1, 0.5, 0, -0.2, -0.2, 0.1, 0.5, 0.2, 0.3];
  expect(breath.map((value) => expiration.receive(value)).flatMap((turned, i) => (turned ? [i] : []))).toEqual([7, 10]);
});
