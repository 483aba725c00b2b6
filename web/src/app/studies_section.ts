import type { Api } from "../connection/api";
import { loadOnOpen, section } from "../dom/rows";
import { t } from "../language/translate";
import type { SessionController } from "../session/session_controller";
import type { Clock } from "../timing/clock";

/** Returns the section of studies, whose code is loaded when it is opened. */
export function studiesSection(api: Api, clock: Clock, controller: SessionController): HTMLElement {
  const panel = section(t("Studies"), false);
  return loadOnOpen(panel, async () => {
    const { fillStudies, Studies } = await import("../panels/jobs/studies_panel");
    fillStudies(panel, new Studies(api, clock), controller);
  });
}
