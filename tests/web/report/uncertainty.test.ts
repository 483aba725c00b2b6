import { beforeEach, describe, expect, test } from "vitest";
import { make } from "../../../web/src/dom/elements";
import { showStudy } from "../../../web/src/report/page";

let page: HTMLElement;

beforeEach(() => {
  page = make("main", {});
  document.body.replaceChildren(page);
});

const show = (result: object) =>
  showStudy(page, JSON.stringify({ id: "x", scene: "cube", state: "STUDY_STATE_DONE", result }));
const all = (selector: string) => [...page.querySelectorAll(selector)];
const drawn = () =>
  all("figure svg")
    .map((svg) => svg.outerHTML)
    .join("");

const inputs = [{ input: "elasticity", unit: "1", distribution: "uniform", nominal: 1, p5: 0.6, p50: 1, p95: 1.4 }];
const sensitivity = {
  inputs,
  screening: [
    { output: "height", unit: "m", input: "elasticity", meanEffect: -2, meanSize: 2, deviation: 0.5, share: 1 },
    { output: "height", unit: "m", input: "breath_force", meanSize: 0, deviation: 0, share: 0 },
    { output: "failed", unit: "m", input: "elasticity" },
  ],
  indices: [
    { output: "height", input: "elasticity", method: "chaos", first: 0.9, total: 1 },
    { output: "height", input: "breath_force", method: "chaos", first: -0.001, total: 0.1 },
    { output: "failed", input: "elasticity", method: "chaos" },
  ],
  fits: [{ output: "height", unit: "m", terms: "6", runs: "13", mean: 1, deviation: 0.2, predictedShare: 0.98 }],
  runs: "30",
  advice: "height: elasticity takes part in 100 % of the variance.",
};
const uncertainty = {
  inputs,
  bands: [
    {
      output: "height",
      unit: "m",
      nominal: 1,
      mean: 1.1,
      deviation: 0.1,
      p5: 0.9,
      p25: 1,
      p50: 1.1,
      p75: 1.2,
      p95: 1.3,
    },
    { output: "failed", unit: "m" },
  ],
  curves: [{ measure: "height", unit: "m", phase: [0, 0.5, 1], p5: [0, 1, 0], p50: [0, 1.5, 0], p95: [0, 2, 0] }],
  samples: [
    { output: "height", unit: "m", values: [0.9, 1, 1.1, 1.1, 1.2, 1.3] },
    { output: "failed", unit: "m" },
  ],
  runs: "7",
  failed: "1",
  problem: "the run diverged at 2 s",
};
const convergence = {
  rows: [
    { varied: "as it is", output: "height", unit: "m", value: 1 },
    { varied: "time step", to: "0.5 ms", output: "height", unit: "m", value: 1.01, changePercent: 1 },
    { varied: "integrator", to: "velocity_verlet", output: "height", unit: "m" },
  ],
  runs: "3",
};

describe("the pages of uncertain inputs", () => {
  test("DrawIndicesAndScreeningAndSayWhatDoesNotVary", () => {
    show({ scene: "cube", sensitivity });
    expect(page.querySelector("h1")!.textContent).toBe("Sensitivity: cube");
    expect(all("figure svg[role=img]").length).toBe(2);
    expect(page.textContent).toContain("predicts 98 % of left-out runs");
    expect(page.textContent).toContain("It does not vary.");
    expect(page.textContent).toContain("30 runs; none failed.");
    expect(drawn()).not.toMatch(/NaN|Infinity|undefined/);
  });

  test("DrawBandsAndSayHowManyRunsFailed", () => {
    show({ scene: "cube", uncertainty });
    expect(all("figure svg[role=img]").length).toBe(2);
    expect(page.querySelector(".advice")!.textContent).toContain("0.9 to 1.3 m in nine of ten runs, median 1.1.");
    expect(page.textContent).toContain("1 FAILED and are left out: the run diverged at 2 s.");
    expect(drawn()).not.toMatch(/NaN|Infinity|undefined/);
  });

  test("NameTheLargestChangeOfAnOutput", () => {
    show({ scene: "cube", convergence });
    expect(page.querySelector(".advice")!.textContent).toBe(
      "The largest change is 1 %, of height with time step 0.5 ms.",
    );
  });
});

describe("the page of credibility", () => {
  const sections = Array.from({ length: 15 }, (_, i) => ({
    section: i + 1,
    title: `Section ${i + 1}`,
    asked: "Something.",
    verdict: (i % 3) + 1,
    required: i < 2,
    reason: "1 of 2 criteria hold.",
    criteria: [
      { number: "exact.cases", accepted: "at least 1", value: 12, unit: "1", verdict: "holds" },
      { number: "bench.mm", accepted: "at most 2", verdict: "no evidence" },
    ],
    missing: ["bench.mm must be at most 2: no evidence"],
  }));
  const credibility = {
    context: { title: "Teach it", question: "Which way?", decision: "Show it", modelInfluence: "RISK_LEVEL_LOW" },
    scene: "cube",
    modelRisk: "RISK_LEVEL_LOW",
    sections,
    missing: [{ section: "Section 2", what: "bench.mm must be at most 2" }],
    versions: [{ of: "Phrenic", is: "1.0" }],
    numbers: [{ name: "exact.cases", value: 12, command: "build/exact_test" }],
    sensitivity,
    uncertainty,
    convergence,
  };

  test("BeginsWithTheJudgementAndFifteenVerdicts", () => {
    show({ scene: "cube", credibility });
    expect(page.querySelector(".advice")!.textContent).toContain("Not everything that this use requires");
    expect(page.querySelector(".advice")!.textContent).toContain("2 Section 2");
    expect(all("table.summary tbody tr").length).toBe(15);
    for (const link of all("table.summary a")) expect(page.querySelector(link.getAttribute("href")!)).not.toBeNull();
    expect(all("h2 .badge").length).toBe(15);
    expect(all("h2").map(({ textContent }) => textContent)).toContain("15 sections");
    expect(page.textContent).toContain("build/exact_test");
  });

  test("SaysThatEverythingRequiredIsShown", () => {
    show({ scene: "cube", credibility: { ...credibility, adequate: true } });
    expect(page.querySelector(".advice.adequate")!.textContent).toContain("Everything that this use requires");
  });
});
