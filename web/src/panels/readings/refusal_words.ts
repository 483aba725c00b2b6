import { t } from "../../language/translate";

/** Returns what graphs say if their samples cannot be read; empty without a reason. */
export function refusalWords(reason: string): string {
  return reason === "" ? "" : t("No new values: {0}", reason);
}
