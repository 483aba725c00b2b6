import type { KeyValueStorage } from "./identity";

/** The names under which Credentials and Identity keep what a launch gives, and the form of each. */
const given = [
  ["account", "phrenic-account"],
  ["join", "phrenic-links"],
  ["respondent", "phrenic-respondent"],
] as const;

/**
 * Returns the storage of this tab's user. A page that a school's platform launches ("#launch=1&join=SECRET...") keeps
 * what the launch gives in `tab`, which ends with the tab: on a computer that several pupils use, nobody answers in the
 * name of the one before. Other pages keep it in `own`.
 */
export function userStorage(address: URL, own: KeyValueStorage, tab: KeyValueStorage): KeyValueStorage {
  const fragment = new URLSearchParams(address.hash.slice(1));
  if (fragment.get("launch") === "1") {
    tab.setItem("phrenic-launch", fragment.has("respondent") ? "learner" : "teacher");
    const secret = (field: string) => /^[0-9a-f]{32}$/.exec(fragment.get(field) ?? "")?.[0] ?? "";
    for (const [field, key] of given) tab.setItem(key, secret(field));
    // Teachers control the session under one name.
    tab.setItem("phrenic-name", secret("control") === "" ? "" : "Teacher");
    const session = address.searchParams.get("session") ?? "";
    tab.setItem("phrenic-tokens", JSON.stringify(secret("control") === "" ? {} : { [session]: secret("control") }));
  }
  return tab.getItem("phrenic-launch") === null ? own : tab;
}
