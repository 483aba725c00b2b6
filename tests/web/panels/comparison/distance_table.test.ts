import { create } from "@bufbuild/protobuf";
import { describe, expect, test } from "vitest";
import { SurfaceDistanceSchema } from "../../../../web/src/gen/phrenic/v1/compare_pb";
import { distanceTable, formatMillimetres } from "../../../../web/src/panels/comparison/distance_table";

describe("the table of distances", () => {
  const table = distanceTable(create(SurfaceDistanceSchema, { meanAToB: 1.23456, hdMax: 150.04, rmsBToA: NaN }));
  const shown = (name: string) => table.querySelector(`[data-measure="${name}"]`)!;

  test("ShowsValuesWithTheirNamesInTheSchema", () => {
    expect(shown("mean_a_to_b").textContent).toBe("1.235");
    expect(shown("hd_max").textContent).toBe("150.0");
    expect(shown("mean_a_to_b").nextElementSibling!.textContent).toBe("mean_a_to_b");
    expect(table.querySelectorAll("[data-measure]").length).toBe(11);
  });

  test("ExplainsValuesByTheHelpOfTheSchema", () => {
    expect(shown("hd95_max").closest("td")!.title).toContain("Larger of p95_a_to_b and p95_b_to_a");
  });

  test("ShowsNaNAsNone", () => {
    expect(shown("rms_b_to_a").textContent).toBe("none");
    expect(formatMillimetres(0)).toBe("0.000");
  });
});
