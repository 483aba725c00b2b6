import { describe, expect, test } from "vitest";
import { tissueKind, tissueOf } from "../../../web/src/viewer/tissues";

describe("the tissue of a body", () => {
  test.each([
    ["diaphragm", "diaphragm", "muscle"],
    ["ribs", "rib-3-left", "bone"],
    ["cartilages", "cartilage-7-right", "cartilage"],
    ["sternum", "xiphoid", "bone"],
    ["spine", "t10", "bone"],
    ["lungs", "lung-right", "lung"],
    ["lungs", "lung-upper-left", "lung"],
    ["discs", "disc-t4", "cartilage"],
    ["liver", "liver", "organ"],
    ["caval-veins", "inferior-vena-cava", "vein"],
    ["airways", "trachea", "airway"],
    ["oesophagus", "oesophagus", "gut"],
    ["kidneys", "kidney-left", "organ"],
    ["scapulae", "scapula-right", "bone"],
    ["upper-lobes", "lobe-upper-left", "lobe"],
    ["cube", "cube", "other"],
  ])("OfLayer %s AndName %s Is %s", (layer, name, kind) => expect(tissueKind({ layer, name })).toBe(kind));

  test("IsSolidInAnOrganAndHollowInAVessel", () => {
    expect(tissueOf({ layer: "heart", name: "heart" }).section).toBeDefined();
    expect(tissueOf({ layer: "heart", name: "heart" }).wall).toBeUndefined();
    for (const name of ["aorta", "inferior-vena-cava", "trachea", "oesophagus", "stomach"]) {
      const { section, wall = 0 } = tissueOf({ layer: name, name });
      expect(section, name).toBeDefined();
      expect(wall, name).toBeGreaterThan(0);
    }
  });

  test("OfBoneIsMattAndThatOfMuscleHasASheen", () => {
    const [bone, muscle] = [tissueOf({ layer: "ribs", name: "rib" }), tissueOf({ layer: "diaphragm", name: "d" })];
    expect(bone.roughness).toBeGreaterThan(muscle.roughness);
    expect(bone.sheen).toBe(0);
    expect(muscle.sheen).toBeGreaterThan(0);
  });
});
