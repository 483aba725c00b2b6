import { fromJsonString } from "@bufbuild/protobuf";
import { make } from "../dom/elements";
import { type Study, StudySchema } from "../gen/phrenic/v1/study_pb";
import type { StudyResult } from "../gen/phrenic/v1/study_results_pb";
import { convergenceParts } from "./convergence_page";
import { costParts } from "./cost_page";
import { credibilityParts } from "./credibility_page";
import { errorParts } from "./error_page";
import { header, titleOf } from "./header";
import { physiologyParts } from "./physiology_page";
import { sensitivityParts } from "./sensitivity_page";
import { stabilityParts } from "./stability_page";
import { streamingParts } from "./streaming_page";
import { uncertaintyParts } from "./uncertainty_page";

/** Fills the page with the study in `json` (proto3 JSON of phrenic.v1.Study), or with a message if it is invalid. */
export function showStudy(page: HTMLElement, json: string): void {
  let study: Study;
  try {
    study = fromJsonString(StudySchema, json, { ignoreUnknownFields: true });
  } catch {
    page.replaceChildren(make("h1", {}, "Phrenic study"), make("p", { className: "none" }, "This page has no study."));
    return;
  }
  document.title = titleOf(study);
  page.replaceChildren(...contentsOf(study));
}

/** Returns the contents of a study: header, plots and tables. */
export function contentsOf(study: Study): HTMLElement[] {
  const { result } = study;
  const parts = result?.result.case === undefined ? [noResult(study)] : partsOf(result);
  return [header(study), ...parts, disclaimer()];
}

/** Returns the plots and tables of the kind of study. */
function partsOf({ result }: StudyResult): HTMLElement[] {
  if (result.case === "error") return errorParts(result.value);
  if (result.case === "stability") return stabilityParts(result.value);
  if (result.case === "cost") return costParts(result.value);
  if (result.case === "physiology") return physiologyParts(result.value);
  if (result.case === "sensitivity") return sensitivityParts(result.value);
  if (result.case === "uncertainty") return uncertaintyParts(result.value);
  if (result.case === "convergence") return convergenceParts(result.value);
  if (result.case === "credibility") return credibilityParts(result.value);
  return result.case === "streaming" ? streamingParts(result.value) : [];
}

function noResult({ problem }: Study): HTMLElement {
  return make("p", { className: "none" }, problem === "" ? "This study has no result." : `No result: ${problem}`);
}

function disclaimer(): HTMLElement {
  return make("footer", {}, "Phrenic. Research and teaching; not for clinical use.");
}
