import { describe, expect, test } from "vitest";
import { Structures } from "../../../web/src/anatomy/structures";
import { countOfTerms, termsOf } from "../../../web/src/anatomy/terms";
import { Placement } from "../../../web/src/gen/phrenic/v1/frames_pb";
import type { Body } from "../../../web/src/geometry/bodies";

const none = new Uint32Array();

function body(name: string, rest: number[] = [0, 0, 0], rigidLinks: number[] = []): Body {
  return {
    name,
    layer: name,
    layerTitle: name,
    color: "#fff",
    opacity: 1,
    placement: Placement.STREAMED,
    pose: 0,
    firstVertex: 0,
    rest: Float32Array.from(rest),
    triangles: Uint32Array.from(rest.length > 9 ? [0, 1, 2, 3, 4, 5] : []),
    edges: none,
    rigidLinks: Uint32Array.from(rigidLinks),
    attached: none,
    fixed: none,
    actionLines: [],
  };
}

const sides = ["right", "left"];
const numbered = (count: number, name: (i: number) => string) => Array.from({ length: count }, (_, i) => name(i + 1));
/** The bodies of the scene "thorax", and of a spine with five lumbar vertebrae. */
const names = [
  ...sides.flatMap((side) => numbered(12, (i) => `rib-${i}-${side}`)),
  ...sides.flatMap((side) => numbered(10, (i) => `cartilage-${i}-${side}`)),
  ...["manubrium", "sternum-body", "xiphoid", "lung-right", "lung-left", "diaphragm-middle", "chest-wall"],
  ...numbered(12, (i) => `t${i}`),
  ...numbered(5, (i) => `l${i}`),
  ...numbered(12, (i) => `disc-t${i}`),
  ...numbered(5, (i) => `disc-l${i}`),
  ...["heart", "aorta", "superior-vena-cava", "inferior-vena-cava", "trachea", "oesophagus"],
  ...["liver", "stomach", "spleen", "fissure-horizontal-right", "lobe-middle-right"],
  ...sides.flatMap((side) =>
    ["kidney", "clavicle", "scapula", "fissure-oblique", "lobe-upper", "lobe-lower"].map((name) => `${name}-${side}`),
  ),
];
/** Vertices of a diaphragm: right and left dome, right and left crus, and two of the central tendon. */
const diaphragm = [-0.08, 0, 0.2, 0.08, 0, 0.2, -0.01, 0, 0.03, 0.01, 0, 0.03, -0.02, 0, 0.21, 0.02, 0, 0.21];
const lumbar = body("l1", [0, 0, 0.05, 0, 0, 0.09]);

describe("the terminology", () => {
  test("HasASentenceForEachOfMoreThanSixtyStructures", () => {
    const terms = names.flatMap(termsOf);
    expect(terms).toHaveLength(names.length);
    expect(countOfTerms()).toBeGreaterThan(60);
    for (const { name, definition } of terms) {
      expect(definition, name).toMatch(/^[A-Z].{20,}\.$/);
      expect(name).not.toMatch(/[{}]|undefined|NaN/);
    }
  });

  test("HasALatinNameForEachStructureOfThePatient", () => {
    const known = names.filter((name) => name !== "diaphragm-middle").flatMap(termsOf);
    for (const { name, latin } of known) expect(latin, name).toMatch(/^[A-Z][a-z]+/);
  });

  test("NamesEachStructureOnce", () => {
    const all = [...names, "diaphragm"].flatMap(termsOf).map(({ name }) => name);
    expect(new Set(all).size).toBe(all.length);
  });

  test("NamesSidesAndNumbers", () => {
    expect(termsOf("rib-3-right")[0]).toMatchObject({ name: "Right 3rd rib", latin: "Costa III dextra" });
    expect(termsOf("rib-11-left")[0]).toMatchObject({ name: "Left 11th rib", latin: "Costa XI sinistra" });
    expect(termsOf("t10")[0]).toMatchObject({ name: "Tenth thoracic vertebra (T10)", latin: "Vertebra thoracica X" });
    expect(termsOf("lung-upper-left")[0].latin).toBe("Lobus superior pulmonis sinistri");
    expect(termsOf("lobe-upper-left")[0].latin).toBe("Lobus superior pulmonis sinistri");
    expect(termsOf("kidney-right")[0]).toMatchObject({ name: "Right kidney", latin: "Ren dexter" });
    expect(termsOf("cube")).toEqual([]);
  });
});

describe("the structures of a scene", () => {
  const structures = new Structures([body("diaphragm", diaphragm), lumbar, ...names.map((name) => body(name))]);
  const first = (text: string) => structures.search(text)[0]?.name;

  test("AreFoundByEnglishAndLatinWords", () => {
    expect(first("diaphragm")).toBe("Diaphragm");
    expect(first("5th rib left")).toBe("Left 5th rib");
    expect(first("rib 5 right")).toBe("Right 5th rib");
    expect(first("costa xii dextra")).toBe("Right 12th rib");
    expect(first("T10")).toBe("Tenth thoracic vertebra (T10)");
    expect(first("crus dex")).toBe("Right crus of the diaphragm");
    expect(first("pulmo sin")).toBe("Left lung");
  });

  test("AreFoundByTheirOwnName", () => {
    for (const { name } of structures.all) expect(first(name)).toBe(name);
  });

  test("AreNotFoundByOtherWords", () => {
    expect(structures.search("heart attack")).toEqual([]);
    expect(structures.search("  ")).toEqual([]);
  });

  test("DivideTheDiaphragmByWhatTheGeometryTells", () => {
    const regions = [0, 1, 2, 3, 4].map((vertex) => structures.at({ body: "diaphragm", vertex })?.region);
    expect(regions).toEqual(["right half", "left half", "right crus", "left crus", "right half"]);
    const withTendon = new Structures([body("diaphragm", diaphragm, [4, 5]), lumbar]);
    expect(withTendon.at({ body: "diaphragm", vertex: 4 })?.name).toBe("Central tendon of the diaphragm");
    expect(structures.search("central tendon")).toEqual([]);
  });

  test("HaveVerticesThatDivideTheBody", () => {
    const parts = structures.all.filter(({ body, region }) => body === "diaphragm" && region !== "");
    const vertices = parts.flatMap((part) => part.vertices ?? []);
    expect(vertices.sort()).toEqual([0, 1, 2, 3, 4, 5]);
  });

  test("HaveNoNameInAnotherScene", () => {
    expect(new Structures([body("cube")]).at({ body: "cube", vertex: 0 })).toBeUndefined();
  });
});
