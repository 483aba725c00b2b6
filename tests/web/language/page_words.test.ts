import { afterEach, expect, test } from "vitest";
import { applyMessages } from "../../../web/src/language/language";
import { inPageLanguage, useOwnWords } from "../../../web/src/language/page_words";
import { t, useMessages } from "../../../web/src/language/translate";

const page = `<html><body><p>Close</p><noscript>No</noscript><script type="text/plain" id="motion">AA</script></body></html>`;
const file = () => new Blob([page], { type: "text/html" });

afterEach(() => applyMessages({}, "en", "en"));

test("AnEnglishPageIsTakenHomeAsItIs", async () => {
  expect(await (await inPageLanguage(file())).text()).toBe(page);
});

test("APageThatIsTakenHomeHasTheWordsOfItsLanguage", async () => {
  applyMessages({ Close: "Schließen", Evil: "</script><b>" }, "de", "de");
  const html = await (await inPageLanguage(file())).text();
  expect(html).toContain('id="motion">AA</script>');
  expect(html.match(/<\/script>/g)).toHaveLength(2);
  useMessages({}, "en");
  document.documentElement.innerHTML = html;
  useOwnWords();
  expect(document.documentElement.lang).toBe("de");
  expect(document.querySelector("p")?.textContent).toBe("Schließen");
  expect(t("Evil")).toBe("</script><b>");
});
