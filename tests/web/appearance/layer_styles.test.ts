import { create } from "@bufbuild/protobuf";
import { beforeEach, expect, test } from "vitest";
import { LayerStyles } from "../../../web/src/appearance/layer_styles";
import { Placement } from "../../../web/src/gen/phrenic/v1/frames_pb";
import { CompileReportSchema } from "../../../web/src/gen/phrenic/v1/report_pb";
import { decodeBody } from "../../../web/src/geometry/bodies";
import { triangleBody } from "../fakes/fake_server";

const body = (name: string, layer: string, opacity: number, placement = Placement.STREAMED) =>
  decodeBody(triangleBody({ name, layer, opacity, placement }));
const bodies = [
  body("dome", "muscle", 1),
  body("middle", "mechanics", 0),
  body("rib", "bones", 0, Placement.RIGID),
  body("lung", "lungs", 0.3),
];
let styles: LayerStyles;

beforeEach(() => {
  styles = new LayerStyles();
  styles.start(bodies, create(CompileReportSchema, {}));
});

test("ALayerThatTheSceneHidesIsHiddenAndOpaqueOnceShown", () => {
  expect(styles.get("mechanics")).toMatchObject({ visible: false, opacity: 1 });
  expect(styles.get("lungs")).toMatchObject({ visible: true, opacity: 0.3 });
});

test("BodiesThatTheSceneHidesAreNotNeededBeforeTheyAreShown", () => {
  expect(styles.neededBodies(bodies)).toEqual(["dome", "lung"]);
  styles.change("muscle", { visible: false });
  expect(styles.neededBodies(bodies)).toEqual(["dome", "lung"]);
  styles.change("mechanics", { visible: true });
  expect(styles.neededBodies(bodies)).toEqual([]);
  styles.change("mechanics", { visible: false });
  expect(styles.neededBodies(bodies)).toEqual([]);
});

test("AnotherSceneStartsAnew", () => {
  styles.change("mechanics", { visible: true });
  styles.start(bodies, create(CompileReportSchema, {}));
  expect(styles.neededBodies(bodies)).toEqual(["dome", "lung"]);
  styles.start(bodies.slice(0, 1), create(CompileReportSchema, {}));
  expect(styles.neededBodies(bodies.slice(0, 1))).toEqual([]);
});
