import { describe, expect, test } from "vitest";
import { isSoftwareRenderer, Pace, QualityChooser } from "../../../web/src/viewer/quality";

/** Records drawn frames every `interval` ms for `time` ms. */
function run(chooser: QualityChooser, interval: number, time: number): void {
  for (let now = 0; now < time; now += interval) chooser.recordFrame(now, true);
}

describe("the quality", () => {
  test("StaysFullOnAFastMachine", () => {
    const chooser = new QualityChooser(false);
    run(chooser, 16, 10_000);
    expect(chooser.quality).toBe("full");
  });

  test("GoesDownStepByStepOnASlowMachine", () => {
    const chooser = new QualityChooser(false);
    const seen = new Set<string>();
    for (let now = 0; now < 5000; now += 60) {
      chooser.recordFrame(now, true);
      seen.add(chooser.quality);
    }
    expect([...seen]).toEqual(["full", "balanced", "plain"]);
  });

  test("IsNotReducedByPausesOrSingleSlowFrames", () => {
    const chooser = new QualityChooser(false);
    for (let i = 0; i < 200; i++) chooser.recordFrame(500 * i, i % 2 === 0);
    let now = 200_000;
    for (let i = 0; i < 200; i++) chooser.recordFrame((now += i % 5 === 0 ? 300 : 16), true);
    expect(chooser.quality).toBe("full");
  });

  test("IsPlainWhereTheProcessorDraws", () => {
    expect(new QualityChooser(true).quality).toBe("plain");
    expect(isSoftwareRenderer("ANGLE (Google, Vulkan 1.3.0 (SwiftShader Device (Subzero)), SwiftShader driver)")).toBe(
      true,
    );
    expect(isSoftwareRenderer("llvmpipe (LLVM 15.0.6, 256 bits)")).toBe(true);
    expect(isSoftwareRenderer("ANGLE (NVIDIA, NVIDIA GeForce RTX 3060 Direct3D11 vs_5_0 ps_5_0, D3D11)")).toBe(false);
  });

  test("IsTheChoiceOfTheUser", () => {
    const chooser = new QualityChooser(true, "full");
    run(chooser, 500, 60_000);
    expect(chooser.quality).toBe("full");
  });
});

describe("the pace", () => {
  /** Drawings in ten seconds of animation frames every `interval` ms, of which each may be drawn. */
  const drawings = (pace: Pace, interval: number) => {
    let count = 0;
    for (let now = 0; now < 10_000; now += interval) if (pace.starts(now)) count++;
    return count;
  };

  test("IsFifteenPicturesASecondWhereTheProcessorDraws", () => {
    expect(drawings(new Pace(true), 1000 / 60)).toBeCloseTo(150, -1);
    expect(drawings(new Pace(true), 100)).toBe(100);
  });

  test("IsThatOfTheScreenWithAGraphicsCard", () => expect(drawings(new Pace(false), 10)).toBe(1000));
});
