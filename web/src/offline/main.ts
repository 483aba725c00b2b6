import { embeddedDecoder } from "../decoders/embedded_decoder";
import { elementById } from "../dom/elements";
import { useOwnWords } from "../language/page_words";
import { readMotion } from "../frames/clip";
import { MotionPage } from "./page";
import { t } from "../language/translate";

useOwnWords();
// The panels are open: the page has no buttons for them.
document.body.classList.add("graphs-open", "panel-open");
try {
  const decoder = await embeddedDecoder();
  new MotionPage(decoder, readMotion(decoder, elementById("motion").textContent ?? "")).start();
} catch (error) {
  const reason = error instanceof Error ? error.message : String(error);
  elementById("loading").textContent =
    error instanceof RangeError
      ? t("This file is damaged ({0}): export it again.", reason)
      : t("This browser cannot draw the scene ({0}): the page needs WebGL 2.", reason);
  throw error;
}
