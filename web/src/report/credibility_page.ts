import { make } from "../dom/elements";
import {
  CredibilitySection,
  type CredibilityReport,
  CriterionRowSchema,
  ExactCaseRowSchema,
  NumberRowSchema,
  OrderRowSchema,
  RiskLevel,
  type SectionReport,
  SectionVerdict,
} from "../gen/phrenic/v1/credibility_pb";
import { PhysiologyRowSchema, Verdict } from "../gen/phrenic/v1/physiology_pb";
import { BandRowSchema, ConvergenceRowSchema, FitRowSchema, InputRowSchema } from "../gen/phrenic/v1/uncertainty_pb";
import { convergencePlots } from "./convergence_page";
import { runsSentence } from "./runs_sentence";
import { sensitivityPlots } from "./sensitivity_page";
import { tableOf } from "./table";
import { uncertaintyPlots } from "./uncertainty_page";

const verdicts: Record<SectionVerdict, [string, string, string]> = {
  [SectionVerdict.UNSPECIFIED]: ["■", "not judged", "warn"],
  [SectionVerdict.MET]: ["✔", "met", "good"],
  [SectionVerdict.PARTLY]: ["◐", "partly", "warn"],
  [SectionVerdict.NOT_SHOWN]: ["✖", "not shown", "bad"],
};

const risks: Record<RiskLevel, string> = {
  [RiskLevel.UNSPECIFIED]: "not stated",
  [RiskLevel.LOW]: "low",
  [RiskLevel.MEDIUM]: "medium",
  [RiskLevel.HIGH]: "high",
};

/** Returns the report: the judgement, the verdicts, and a part for each section. */
export function credibilityParts(report: CredibilityReport): HTMLElement[] {
  return [
    judgement(report),
    make("h2", {}, `${report.sections.length} sections`),
    summary(report),
    make("p", { className: "none" }, howToRead),
    ...report.sections.map((section) => sectionPart(report, section)),
  ];
}

const howToRead =
  "A section is met if all of its criteria hold, partly met if some do, and not shown otherwise. Thresholds and their " +
  "reasons are those of the author of the context of use; required are the sections that it names, or else those that " +
  "the model risk demands.";

function judgement({ adequate, sections, context, scene, modelRisk }: CredibilityReport): HTMLElement {
  const met = sections.filter(({ verdict }) => verdict === SectionVerdict.MET).length;
  const required = sections.filter((section) => section.required);
  const open = required.filter(({ verdict }) => verdict !== SectionVerdict.MET);
  const titles = open.map(({ section, title }) => `${section} ${title}`).join(", ");
  const sentence = adequate
    ? `Everything that this use requires has been shown for “${scene}”.`
    : `Not everything that this use requires has been shown for “${scene}”: ${titles || "see What is missing"}.`;
  return make(
    "div",
    { className: `advice ${adequate ? "adequate" : "inadequate"}` },
    make("p", { className: "use" }, context?.title ?? ""),
    make("p", {}, sentence),
    make(
      "p",
      { className: "counts" },
      `${met} of ${sections.length} sections are met, ${required.length - open.length} of the ${required.length} required. ` +
        `Model risk: ${risks[modelRisk]}.`,
    ),
  );
}

function badge(verdict: SectionVerdict): HTMLElement {
  const [mark, words, kind] = verdicts[verdict];
  return make("span", { className: `badge ${kind}` }, `${mark} ${words}`);
}

function summary({ sections }: CredibilityReport): HTMLElement {
  const head = ["", "Section", "Verdict", "Required", "Why"].map((words) => make("th", { scope: "col" }, words));
  const rows = sections.map((section) =>
    make(
      "tr",
      {},
      make("td", { className: "number" }, String(section.section)),
      make("td", {}, make("a", { href: `#section-${section.section}` }, section.title)),
      make("td", {}, badge(section.verdict)),
      make("td", {}, section.required ? "required" : ""),
      make("td", { className: "words" }, section.reason),
    ),
  );
  return make(
    "table",
    { className: "summary" },
    make("thead", {}, make("tr", {}, ...head)),
    make("tbody", {}, ...rows),
  );
}

function sectionPart(report: CredibilityReport, section: SectionReport): HTMLElement {
  const heading = make(
    "h2",
    { id: `section-${section.section}` },
    `${section.section}. ${section.title} `,
    badge(section.verdict),
  );
  return make(
    "section",
    {},
    heading,
    make("p", { className: "none" }, section.asked, section.required ? " Required for this use." : ""),
    ...statements(report, section.section),
    ...(section.criteria.length > 0 ? [tableOf("Criteria", CriterionRowSchema, section.criteria)] : []),
    ...list("Found", section.found),
    ...(section.section === CredibilitySection.MISSING ? missing(report) : list("Missing", section.missing)),
    ...evidenceOf(report, section.section),
  );
}

function list(title: string, sentences: string[]): HTMLElement[] {
  if (sentences.length === 0) return [];
  return [make("h3", {}, title), make("ul", {}, ...sentences.map((sentence) => make("li", {}, sentence)))];
}

/** What the context says in words. */
function statements({ context, modelRisk }: CredibilityReport, section: CredibilitySection): HTMLElement[] {
  if (context === undefined) return [];
  const facts: Partial<Record<CredibilitySection, [string, string][]>> = {
    [CredibilitySection.QUESTION]: [
      ["Question", context.question],
      ["Decision", context.decision],
    ],
    [CredibilitySection.CONTEXT_OF_USE]: [["Context of use", context.contextOfUse]],
    [CredibilitySection.MODEL_RISK]: [
      ["Model influence", `${risks[context.modelInfluence]}: ${context.modelInfluenceReason}`],
      ["Decision consequence", `${risks[context.decisionConsequence]}: ${context.decisionConsequenceReason}`],
      ["Model risk", risks[modelRisk]],
    ],
  };
  const rows = facts[section] ?? [];
  if (rows.length === 0) return [];
  const words = rows.flatMap(([name, value]) => [make("dt", {}, name), make("dd", {}, value || "not stated")]);
  return [make("dl", { className: "statements" }, ...words)];
}

function missing({ missing: rows }: CredibilityReport): HTMLElement[] {
  const sections = [...new Set(rows.map(({ section }) => section))];
  return sections.flatMap((section) =>
    list(
      section,
      rows.filter((row) => row.section === section).map(({ what }) => what),
    ),
  );
}

/** Tables and plots of a section. */
function evidenceOf(report: CredibilityReport, section: CredibilitySection): HTMLElement[] {
  switch (section) {
    case CredibilitySection.CODE_VERIFICATION:
      return [
        ...(report.orders.length > 0 ? [tableOf("Orders of the integrators", OrderRowSchema, report.orders)] : []),
        ...exactCases(report),
      ];
    case CredibilitySection.PLAUSIBILITY:
      return physiology(report);
    case CredibilitySection.CALCULATION_VERIFICATION:
      return convergence(report);
    case CredibilitySection.UNCERTAINTY:
      return uncertainty(report);
    case CredibilitySection.REPEATABILITY:
      return [
        versions(report),
        folded("Every number, with its command", tableOf("Numbers", NumberRowSchema, report.numbers)),
      ];
    default:
      return [];
  }
}

/** Contents behind a heading; a print shows them. */
function folded(title: string, ...content: HTMLElement[]): HTMLElement {
  const details = make("details", {}, make("summary", {}, title), ...content);
  window.addEventListener("beforeprint", () => (details.open = true));
  return details;
}

function exactCases({ exactCases: rows }: CredibilityReport): HTMLElement[] {
  if (rows.length === 0) return [];
  return [folded(`${rows.length} exact cases`, tableOf("Exact cases", ExactCaseRowSchema, rows))];
}

function physiology({ physiology: table }: CredibilityReport): HTMLElement[] {
  if (table === undefined) return [];
  const of = (verdict: Verdict) => table.rows.filter((row) => row.verdict === verdict);
  return [
    tableOf("Outside the published ranges", PhysiologyRowSchema, of(Verdict.OUTSIDE)),
    folded("Inside the published ranges", tableOf("Inside", PhysiologyRowSchema, of(Verdict.INSIDE))),
  ];
}

function convergence({ convergence: table }: CredibilityReport): HTMLElement[] {
  if (table === undefined) return [];
  return [
    make("p", {}, runsSentence(table)),
    ...convergencePlots(table),
    folded("Outputs of each run", tableOf("Outputs", ConvergenceRowSchema, table.rows)),
  ];
}

function uncertainty({ sensitivity, uncertainty: bands }: CredibilityReport): HTMLElement[] {
  const parts: HTMLElement[] = [];
  const inputs = bands?.inputs ?? sensitivity?.inputs ?? [];
  if (inputs.length > 0) parts.push(tableOf("Inputs that are not known exactly", InputRowSchema, inputs));
  if (sensitivity !== undefined) {
    parts.push(
      make("h3", {}, "Which inputs matter"),
      make("p", {}, runsSentence(sensitivity), " ", sensitivity.advice),
    );
    parts.push(...sensitivityPlots(sensitivity), tableOf("Polynomials", FitRowSchema, sensitivity.fits));
  }
  if (bands !== undefined) {
    parts.push(make("h3", {}, "How far the outputs scatter"), make("p", {}, runsSentence(bands)));
    parts.push(...uncertaintyPlots(bands), tableOf("Bands of the outputs", BandRowSchema, bands.bands));
  }
  return parts;
}

function versions({ versions: rows }: CredibilityReport): HTMLElement {
  const words = rows.flatMap(({ of, is }) => [make("dt", {}, of), make("dd", {}, is)]);
  return make("dl", { className: "statements" }, ...words);
}
