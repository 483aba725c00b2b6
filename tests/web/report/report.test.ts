import { beforeEach, describe, expect, test } from "vitest";
import { make } from "../../../web/src/dom/elements";
import { showStudy } from "../../../web/src/report/page";
import { costStudy, errorStudy, pageOf, stabilityStudy, streamingStudy } from "./study_samples";

let page: HTMLElement;

beforeEach(() => {
  page = make("main", {});
  document.body.replaceChildren(page);
});

const show = (study: object) => showStudy(page, JSON.stringify(study));
const captions = () => [...page.querySelectorAll("figcaption")].map((each) => each.textContent ?? "");
const all = (selector: string) => [...page.querySelectorAll(selector)];
const advice = () => all(".advice p").map((each) => each.textContent ?? "");
const done = { id: "x", scene: "cube", state: "STUDY_STATE_DONE" };
/** Returns the study with another table. */
const withTable = (study: typeof errorStudy, kind: string, table: object) => ({
  ...study,
  result: { ...study.result, [kind]: table },
});

describe("the page of a study", () => {
  test.each([errorStudy, stabilityStudy, costStudy])("LabelsAndCaptionsEveryPlot", (study) => {
    show(study);
    expect(all("figure svg[role=img]").length).toBeGreaterThan(2);
    for (const svg of all("figure svg")) expect(svg.getAttribute("aria-label")?.length).toBeGreaterThan(20);
    for (const caption of captions()) expect(caption).toMatch(/^[^.]+\. .+\.$/s);
    for (const caption of captions()) expect(caption).not.toMatch(/undefined|NaN|Infinity/);
    expect(page.textContent).toContain("Research and teaching; not for clinical use");
  });

  test.each([errorStudy, stabilityStudy, costStudy])("DrawsOnlyNumbers", (study) => {
    show(study);
    expect(
      all("figure svg")
        .map((svg) => svg.outerHTML)
        .join(""),
    ).not.toMatch(/NaN|Infinity|undefined/);
  });

  test("ShowsSceneAndParameters", () => {
    show(errorStudy);
    const header = page.querySelector("header")!.textContent!;
    expect(page.querySelector("h1")!.textContent).toBe("Error against run time: thorax");
    expect(header).toContain("3d6792551747970ab59dde977832208208ed8ef8525ebe03783601e643b0e8d9");
    expect(header).toContain("breath length 4 s · apply muscles on");
    expect(header).toContain("integrator Semi-implicit Euler");
    expect(header).toContain("2 s simulated");
    expect(document.title).toBe("Error against run time: thorax – Phrenic");
  });

  test("AcceptsProtoFieldNames", () => {
    show({
      ...done,
      result: {
        scene_hash: "abc",
        error: { advice: "Use velocity_verlet.", rows: [] },
      },
    });
    expect(page.querySelector("header")!.textContent).toContain("abc");
    expect(page.querySelector(".advice")!.textContent).toBe("Use Velocity Verlet.");
  });

  test("EscapesHostileText", () => {
    const scene = `</script><img src=x onerror="alert(1)"><svg onload=alert(1)>`;
    const row = {
      integrator: scene,
      timeStepS: 0.1,
      errorRmsMm: 1,
      cpuPerSecond: 1,
      verdict: scene,
    };
    const rows = [row, { ...row, timeStepS: 0.05, errorRmsMm: 0.5, cpuPerSecond: 2 }];
    show({ ...done, scene, result: { scene, error: { rows, advice: scene } } });
    expect(all("img, script, [onload], [onerror]")).toEqual([]);
    expect(page.querySelector("h1")!.textContent).toBe(`Error against run time: ${scene}`);
    expect(pageOf("<script>__PHRENIC_STUDY__</script>", { scene }).match(/<\/script>/g)).toHaveLength(1);
  });

  test.each(["error", "stability", "cost"])("AcceptsAnEmptyTable", (kind) => {
    show({ ...done, result: { [kind]: {} } });
    expect(page.querySelector("h1")!.textContent).toContain("cube");
    expect(page.textContent).toContain("No rows.");
  });

  test("ShowsWhyThereIsNoResult", () => {
    show({
      ...done,
      state: "STUDY_STATE_FAILED",
      problem: "the study was cancelled",
    });
    expect(page.textContent).toContain("No result: the study was cancelled");
    showStudy(page, "__PHRENIC_STUDY__");
    expect(page.textContent).toContain("This page has no study.");
  });
});

describe("the error study", () => {
  test("ListsTheRunsThatAreNotDrawn", () => {
    show(errorStudy);
    expect(captions()[0]).toContain("Not drawn: 5 runs (Thesis) without a result.");
  });

  test("SwitchesToTheLargestError", () => {
    show(errorStudy);
    const [, largest] = page.querySelectorAll<HTMLInputElement>("input[type=radio]");
    largest.checked = true;
    largest.dispatchEvent(new Event("change"));
    expect(captions()[0]).toContain("Largest error against run time.");
  });

  test("LabelsEveryIntegratorInThePlot", () => {
    show(errorStudy);
    const words = [...page.querySelector("figure svg")!.querySelectorAll("text")].map((each) => each.textContent);
    for (const name of ["Semi-implicit Euler", "Velocity Verlet", "Runge-Kutta 4", "BDF2", "TR-BDF2", "real time"]) {
      expect(words).toContain(name);
    }
  });

  test("AcceptsRowsWithoutErrors", () => {
    const rows = [
      {
        integrator: "thesis",
        verdict: "no step is stable here: it adds energy",
      },
      {
        integrator: "bdf2",
        timeStepS: 0.1,
        cpuPerSecond: "NaN",
        errorRmsMm: "Infinity",
        verdict: "ok",
      },
      {
        integrator: "tr_bdf2",
        timeStepS: 0.1,
        cpuPerSecond: 0,
        errorRmsMm: 0,
        verdict: "ok",
      },
    ];
    show(withTable(errorStudy, "error", { rows }));
    expect(captions()[0]).toContain("No run has an error to show.");
    expect(all("tbody tr").length).toBe(3);
  });

  test("MentionsRealTimeOutsideOfThePlot", () => {
    const row = {
      integrator: "bdf2",
      timeStepS: 0.1,
      errorRmsMm: 1,
      cpuPerSecond: 1e-5,
      verdict: "ok",
    };
    show(withTable(errorStudy, "error", { rows: [row] }));
    expect(captions()[0]).toContain("All runs are much faster than real time.");
  });
});

describe("the stability study", () => {
  test("DrawsOneMapForEachIntegrator", () => {
    show(stabilityStudy);
    expect(all(".tiles h3").map((each) => each.textContent)).toEqual([
      "Semi-implicit Euler",
      "Velocity Verlet",
      "Runge-Kutta 4",
      "TR-BDF2",
    ]);
    const axes = all(".tiles svg").map((svg) => svg.textContent);
    expect(axes[0]).toContain("Time step over predicted limit");
    expect(axes[3]).toContain("Time step [ms]");
    expect(captions()[0]).toContain("Velocity Verlet 1 to 1.06");
  });

  test("CountsAndMarksExtremeCases", () => {
    show(stabilityStudy);
    expect(advice()).toContain("3 extreme cases: 1 pass, 1 stopped with a reason, 1 FAILED.");
    expect(page.querySelector(".verdict.bad")!.textContent).toBe("✖ FAILED");
  });

  test("ShowsLargestStepsAndUnconditionalStability", () => {
    show(stabilityStudy);
    expect(advice()[0]).toMatch(/^Longest stable step: Semi-implicit Euler .* ms \(10⁶ times as stiff: .* ms\)/);
    expect(advice().some((line) => line.startsWith("Stable at every stiffness"))).toBe(false);
    const map = [{ integrator: "bdf2", stiffness: 1, timeStepS: 0.01, verdict: "damped" }];
    show(withTable(stabilityStudy as never, "stability", { map }));
    expect(advice()).toEqual(["Stable at every stiffness and step of the map: BDF2."]);
  });

  test("AcceptsASingleRunWithoutALimit", () => {
    const map = [{ integrator: "bdf2", stiffness: 1, timeStepS: 0.01, verdict: "stable" }];
    show(withTable(stabilityStudy as never, "stability", { map }));
    expect(all(".tiles svg").length).toBe(1);
    expect(page.querySelector(".tiles")!.innerHTML).not.toMatch(/NaN/);
  });
});

describe("the streaming study", () => {
  test("DrawsLossyCodecsAndMentionsTheExactOne", () => {
    show(streamingStudy as never);
    expect(page.querySelector("h1")!.textContent).toBe("Error against bandwidth: thorax");
    expect(advice().join() || page.querySelector(".advice")!.textContent).toContain("28.3 Mbit/s");
    const [drawn] = all("figure svg[role=img]");
    expect(drawn.outerHTML).not.toMatch(/NaN|Infinity|undefined/);
    for (const name of ["Planes", "Predicted", "Basis"]) expect(drawn.textContent).toContain(name);
    expect(captions()[0]).toContain("Raw frames are exact and take 91.5 Mbit/s.");
    expect(page.textContent).toContain("31\u202f772 vertices, 16 frames");
    expect(all("tbody tr")).toHaveLength(10);
  });

  test("AcceptsAnEmptyTable", () => {
    show(withTable(streamingStudy as never, "streaming", {}));
    expect(captions()[0]).toContain("No codec has an error to show.");
  });
});

describe("the cost study", () => {
  test("ShowsTheValueOfTheThesisBesideTheBar", () => {
    show(costStudy);
    expect(page.querySelector("figure svg")!.textContent).toContain("214 µs, 26.4 % (thesis 625 µs, 2.92 × its speed)");
    expect(captions()[2]).toContain("to the power of 1.04");
  });

  test("SummarisesTheCostOfAStepAndOfOmittedParts", () => {
    show(costStudy);
    expect(advice()[0]).toBe("A step takes 812 µs, 3 times the speed of the thesis.");
    expect(advice()[1]).toBe("Most of it goes to springs.");
    const rows = [0.99, 1.02].map((overNeverHad) => ({
      variant: "links left out",
      cpuUsPerStep: 9,
      overNeverHad,
    }));
    show(withTable(costStudy as never, "cost", { rows }));
    expect(advice()).toEqual(["Time with a part left out, relative to a scene without it: 0.99 to 1.02."]);
  });

  test("AcceptsVariantsWithoutStagesAndGrowth", () => {
    const rows = [{ variant: "full", cpuUsPerStep: 12 }, { variant: "springs alone" }];
    show(withTable(costStudy as never, "cost", { rows }));
    expect(captions().length).toBe(1);
    expect(all("tbody tr").length).toBe(2);
  });
});

describe("the page of physiology", () => {
  const curve = (breath: string, what: string, unit: string) => ({
    breath,
    what,
    unit,
    timeS: [0, 1, 2],
    values: [0, 2, 1],
  });
  const study = {
    ...done,
    result: {
      scene: "thorax",
      physiology: {
        rows: [
          { breath: "quiet", what: "tidal volume", unit: "l", value: 0.6, verdict: "VERDICT_INSIDE" },
          { breath: "deep", what: "tendon area change", unit: "%", value: 6, verdict: "VERDICT_OUTSIDE" },
          { breath: "deep", what: "mean descent", unit: "mm", value: 27, verdict: "VERDICT_NOT_JUDGED" },
        ],
        curves: [
          curve("quiet", "lung volume", "l"),
          curve("quiet", "right dome, apex", "mm"),
          curve("deep", "lung volume", "l"),
        ],
      },
    },
  };

  test("DrawsTheCurvesOfTheBreathThatIsChosen", () => {
    show(study);
    expect(page.querySelector("h1")!.textContent).toBe("Physiology: thorax");
    expect(page.textContent).toContain("1 of 2 values are inside");
    expect(all("figure svg[role=img]").length).toBe(2);
    const [, deep] = all("input[name=breath]") as HTMLInputElement[];
    deep.onchange!(new Event("change"));
    expect(all("figure svg[role=img]").length).toBe(1);
  });
});
