import { applyMessages, type Language, pageLanguage } from "./language";
import { type Messages, usedMessages } from "./translate";

const id = "messages";

/** Returns an HTML page that plays by itself with the words of this page's language in it; English needs none. */
export async function inPageLanguage(page: Blob): Promise<Blob> {
  if (pageLanguage() === "en") return page;
  const html = await page.text();
  const words = JSON.stringify(usedMessages()).replaceAll("<", "\\u003c");
  const element = `<script type="application/json" id="${id}" data-language="${pageLanguage()}">${words}</script>`;
  return new Blob([html.replace("</noscript>", () => `</noscript>${element}`)], { type: page.type });
}

/** Sets the language of a page by the words in it, if it has any. */
export function useOwnWords(): void {
  const element = document.getElementById(id);
  if (element === null) return;
  const language = element.dataset.language as Language;
  applyMessages(JSON.parse(element.textContent) as Messages, language, language);
}
