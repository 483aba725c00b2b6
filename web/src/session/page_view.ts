import type { KeyValueStorage } from "../connection/identity";

/** What the page is for: a class sees plain words and few controls, an expert every control. */
export type PageView = "student" | "expert";

const key = "phrenic-view";

/**
 * Returns the view of a page: the one that its address names, the student view for a lesson, else the one that this
 * browser chose last, else the student view for a join link and the expert view for other addresses.
 */
export function pageViewOf(address: URL, storage: KeyValueStorage): PageView {
  const joins = new URLSearchParams(address.hash.slice(1)).has("join");
  const lesson = address.searchParams.has("lesson") ? "student" : null;
  const wanted = address.searchParams.get("view") ?? lesson ?? storage.getItem(key) ?? (joins ? "student" : "expert");
  return wanted === "student" ? "student" : "expert";
}

/** Remembers the view for the next page of this browser. */
export function rememberPageView(view: PageView, storage: KeyValueStorage): void {
  storage.setItem(key, view);
}

/** Returns the query string `query` with the view in it: without it, the browser's memory decides. */
export function withPageView(query: string, view: PageView): string {
  const parameters = new URLSearchParams(query);
  parameters.set("view", view);
  return `?${parameters}`;
}
