import type { KeyValueStorage } from "./identity";

/** The names under which Credentials and Identity keep what a launch gives, and the form of each. */
const given = [
  ["account", "phrenic-account"],
  ["join", "phrenic-links"],
  ["respondent", "phrenic-respondent"],
] as const;

/**
 * Returns the storage of this tab's user. A page that a school's platform launches ("#launch=1&join=SECRET...") keeps
 * what the launch gives in `tab`, which ends with the tab: on a computer that several pupils use, no pupil answers in
 * the name of the one before. Other pages keep it in `own`.
 */
export function userStorage(address: URL, own: KeyValueStorage, tab: KeyValueStorage): KeyValueStorage {
  const fragment = new URLSearchParams(address.hash.slice(1));
  if (fragment.get("launch") === "1") keepLaunch(address, fragment, tab);
  return tab.getItem("phrenic-launch") === null ? own : tab;
}

function keepLaunch(address: URL, fragment: URLSearchParams, tab: KeyValueStorage): void {
  const secret = (field: string) => /^[0-9a-f]{32}$/.exec(fragment.get(field) ?? "")?.[0] ?? "";
  const kind = fragment.has("respondent") ? "learner" : "teacher";
  const kept = (key: string) => tab.getItem(key) ?? "";
  const sameKind = kept("phrenic-launch") === kind;
  const sameRespondent = secret("respondent") === kept("phrenic-respondent");
  const sameLink = secret("join") !== "" && kept("phrenic-links").split(",").includes(secret("join"));
  const sameAccount = secret("account") !== "" && kept("phrenic-account") === secret("account");
  // The next page of a launch has the same fragment: what was kept since then stays.
  if (sameKind && (sameAccount || (sameLink && sameRespondent))) return;
  // Another learner must not get the control tokens of the user before.
  const tokens = sameKind && (kind === "teacher" || sameRespondent) ? kept("phrenic-tokens") : "";
  tab.setItem("phrenic-launch", kind);
  for (const [field, key] of given) tab.setItem(key, secret(field));
  // Teachers control the session under one name.
  tab.setItem("phrenic-name", secret("control") === "" ? "" : "Teacher");
  const session = address.searchParams.get("session") ?? "";
  const added = secret("control") === "" ? {} : { [session]: secret("control") };
  tab.setItem("phrenic-tokens", JSON.stringify({ ...parse(tokens), ...added }));
}

function parse(tokens: string): Record<string, string> {
  try {
    return JSON.parse(tokens) as Record<string, string>;
  } catch {
    return {};
  }
}
