// Studies in the format in which the server embeds them into their page (proto3 JSON), invented but of realistic size.

const parameters = {
  timeStep: 0.00079,
  breathForce: 1,
  breathLength: 4,
  ribMotion: 1,
  elasticity: 1,
  applyMuscles: true,
  applyLinks: true,
  integrator: "INTEGRATOR_SEMI_IMPLICIT_EULER",
  stepTolerance: 0,
};

function study(kind: string, result: object, scene = "thorax") {
  const sceneHash = "3d6792551747970ab59dde977832208208ed8ef8525ebe03783601e643b0e8d9";
  return {
    id: `${kind}-${scene}-1`,
    scene,
    state: "STUDY_STATE_DONE",
    progress: 1,
    result: { [kind]: result, scene, sceneHash, parameters, tookS: 98.646 },
  };
}

// Name, order, RMS error at the first step [mm], first step [s], CPU time of a step [s].
const integrators: [string, number, number, number, number][] = [
  ["semi_implicit_euler", 1, 9.5, 0.0109, 1.0e-3],
  ["explicit_euler", 1, 0.29, 0.000035, 0.9e-3],
  ["velocity_verlet", 1.95, 4.2, 0.0109, 1.1e-3],
  ["runge_kutta_4", 3.9, 3.1, 0.0156, 3.9e-3],
  ["linear_implicit_euler", 0.8, 32, 0.0312, 1.6e-2],
  ["bdf2", 1.7, 23, 0.0312, 2.6e-2],
  ["tr_bdf2", 1.9, 15, 0.0312, 4.1e-2],
];

function errorRow([integrator, order, first, step, cpu]: (typeof integrators)[number], level: number) {
  const errorRmsMm = first / 2 ** (order * level);
  const cpuPerSecond = (cpu / step) * 2 ** level;
  return {
    integrator,
    timeStepS: step / 2 ** level,
    errorMaxMm: 3.7 * errorRmsMm,
    errorRmsMm,
    errorProbeMm: 1.4 * errorRmsMm,
    errorEnergyJ: 1e-3 * errorRmsMm,
    cpuPerSecond,
    ...(cpuPerSecond < 1 ? { realTime: true } : { realTime: false }),
    ...(level < 4 ? { order } : {}),
    ...(integrator === "velocity_verlet" ? { pareto: true } : {}),
    verdict: "ok",
  };
}

const diverged = [0, 1, 2, 3, 4].map((level) => ({
  integrator: "thesis",
  timeStepS: 0.0109 / 2 ** level,
  cpuPerSecond: 0.09 * 2 ** level,
  verdict: `diverged at ${(0.076 / 2 ** level).toPrecision(3)} s`,
}));

export const errorStudy = study("error", {
  reference: {
    method: "CVODE, Adams-Moulton of variable order",
    toleranceM: 1e-9,
    errorMaxMm: 0.0008,
    errorRmsMm: 0.00013,
    evaluations: "5830",
    cpuS: 26.4,
    largestDisplacementMm: 130,
  },
  rows: [...integrators.flatMap((each) => [0, 1, 2, 3, 4].map((level) => errorRow(each, level))), ...diverged],
  advice:
    "For an error of 0.1 mm at any vertex use velocity_verlet at 0.68 ms: its error is 0.07 mm and it runs 1.6 times slower than real time.",
  resolutions: [12, 9, 7, 5].map((resolutionMm, i) => ({
    resolutionMm,
    vertices: String(Math.round(90_000 / resolutionMm ** 2)),
    ...(i < 3 ? { errorProbeMm: 0.011 * (resolutionMm - 5) ** 1.6, cpuPerSecond: 70 / resolutionMm ** 2 } : {}),
    verdict: i < 3 ? "ok" : "the finest",
  })),
  residuals: ["exact", "thesis"].flatMap((projection, i) =>
    [1, 2, 3, 4, 5, 6, 7, 8].map((moment) => ({
      projection,
      timeS: moment / 4,
      residualMm: i === 0 ? 2.6e-14 * (1 + 0.2 * (moment % 3)) : 0.004 * moment ** 1.5,
      errorRmsMm: i === 0 ? 0.0011 * moment : 0.9 * moment ** 1.8,
    })),
  ),
  seconds: 2,
});

const stiffnesses = [1, 10, 100, 1e3, 1e4, 1e5, 1e6];
const explicit: [string, number, number][] = [
  ["semi_implicit_euler", 0.00088, 1.01],
  ["velocity_verlet", 0.00088, 1.004],
  ["runge_kutta_4", 0.00122, 0.98],
];

function mapRow(integrator: string, stiffness: number, timeStepS: number, verdict: string) {
  const burst = { divergedAtS: 0.021, where: "diaphragm vertex 812: springs", energyRatio: 4.1e9 };
  return { integrator, stiffness, timeStepS, verdict, ...(verdict === "diverged" ? burst : { energyRatio: 1.02 }) };
}

const powers = [-3, -2, -1, 0, 1, 2, 3];

export const stabilityStudy = study("stability", {
  limits: [
    ...explicit.flatMap(([integrator, limit, ratio]) =>
      stiffnesses.map((stiffness) => {
        const predictedS = limit / Math.sqrt(stiffness);
        const own = ratio + 0.01 * Math.log10(stiffness);
        return { integrator, stiffness, predictedS, measuredS: predictedS * own, ratio: own };
      }),
    ),
    ...stiffnesses.map((stiffness) => ({ integrator: "tr_bdf2", stiffness })),
  ],
  map: [
    ...explicit.flatMap(([integrator, limit]) =>
      stiffnesses.flatMap((stiffness) =>
        powers.map((power) => {
          const late = stiffness >= 1e5 && power < -1 ? "out of time" : "stable";
          return mapRow(
            integrator,
            stiffness,
            (limit * 2 ** power) / Math.sqrt(stiffness),
            power > 0 ? "diverged" : late,
          );
        }),
      ),
    ),
    ...stiffnesses.flatMap((stiffness) =>
      powers.map((power) => {
        const verdict =
          stiffness * 4 ** power > 1e4 ? (power === 3 && stiffness > 1e5 ? "stopped" : "damped") : "stable";
        return mapRow("tr_bdf2", stiffness, 0.004 * 2 ** power, verdict);
      }),
    ),
  ],
  extremes: [
    {
      case: "stiffness times 1e6",
      integrator: "tr_bdf2",
      verdict: "pass",
      finite: true,
      energyRatio: 0.98,
      errorRmsMm: 0.21,
    },
    {
      case: "a vertex without mass",
      integrator: "velocity_verlet",
      verdict: "stopped",
      finite: true,
      note: "the compile step refuses vertex 3 of lung: give it a density",
    },
    { case: "breath force 20", integrator: "semi_implicit_euler", verdict: "FAILED", note: "not finite at 0.4 s" },
  ],
});

// Variant, links, CPU time per step [us], steps/s in the thesis, cost relative to a scene that never had the part.
const variants: [string, number, number, number?, number?][] = [
  ["full", 2310, 812, 410],
  ["without rigid links", 0, 497, undefined, 1.004],
  ["without muscles", 2310, 771, undefined, 0.996],
  ["without collisions", 2310, 640, undefined, 1.01],
  ["without volume constraints", 2310, 655],
  ["springs alone", 0, 214, 1600, 1.002],
];

export const costStudy = study("cost", {
  rows: variants.map(([variant, links, us, thesis, never]) => ({
    variant,
    vertices: "4480",
    springs: "25716",
    ...(links > 0 ? { links: String(links) } : {}),
    stepsPerS: 1e6 / us,
    cpuUsPerStep: us,
    nsPerVertexStep: (1e3 * us) / 4480,
    spread: 0.021,
    share: us / 812,
    ...(thesis === undefined ? {} : { thesisStepsPerS: thesis, timesThesis: 1e6 / us / thesis }),
    ...(never === undefined ? {} : { overNeverHad: never }),
  })),
  stages: [
    { stage: "forces", element: "springs", usPerStep: 291, share: 0.358 },
    { stage: "forces", element: "finite elements", usPerStep: 118, share: 0.145 },
    { stage: "constraints", element: "rigid links", usPerStep: 233, share: 0.287 },
    { stage: "constraints", element: "volume", usPerStep: 96, share: 0.118 },
    { stage: "motions", usPerStep: 41, share: 0.05 },
    { stage: "integration", usPerStep: 33, share: 0.041 },
  ],
  growth: [
    ...[12, 9, 7, 5, 4].map((edge) => growthRow("thorax", Math.round(90_000 / edge ** 2), 0.29)),
    ...[5_000, 20_000, 100_000, 500_000].map((vertices) => growthRow("sheets of springs", vertices, 0.05)),
  ],
  growthExponent: 1.043,
});

function growthRow(what: string, vertices: number, each: number) {
  const cpuUsPerStep = each * vertices ** 1.043;
  return { what, vertices: String(vertices), cpuUsPerStep, nsPerVertexStep: (1e3 * cpuUsPerStep) / vertices };
}

// Bytes per frame for error bounds of 0.01, 0.1 and 1 mm.
const codecs: [string, number[]][] = [
  ["planes", [170_300, 117_700, 93_900]],
  ["predicted", [32_600, 12_900, 5400]],
  ["basis", [6350, 44, 44]],
];

export const streamingStudy = study("streaming", {
  rows: [
    { codec: "raw", bytesPerFrame: 381_264, mbitPerSecond: 91.5, pareto: true, verdict: "ok" },
    ...codecs.flatMap(([codec, sizes]) =>
      sizes.map((bytesPerFrame, i) => {
        const boundMm = 0.01 * 10 ** i;
        const mbitPerSecond = 240e-6 * bytesPerFrame;
        const errors = { errorMaxMm: 0.99 * boundMm, errorRmsMm: 0.55 * boundMm };
        const times = { encodeUs: 1039, decodeUs: 756 };
        return { codec, boundMm, bytesPerFrame, mbitPerSecond, ...errors, ...times, verdict: "ok" };
      }),
    ),
  ],
  vertices: "31772",
  frames: "16",
  basisBytes: "92984",
  advice: "Within 0.1 mm a frame takes 118 kB by planes (28.3 Mbit/s) at 30 frames a second.",
});

/** Returns the page as the server generates it (server/service/study_page.cc). */
export function pageOf(page: string, study: object): string {
  const json = JSON.stringify(study).replaceAll("<", "\\u003c");
  return page.replace("__PHRENIC_STUDY__", () => json);
}
