import type { Api } from "../connection/api";
import { FilmMaker, type OpenWriter } from "../film/film_maker";
import { recordedMotion } from "../film/recorded_motion";
import type { DisplayedFrame } from "../frames/frame_buffer";
import type { CompileReport } from "../gen/phrenic/v1/report_pb";
import { inPageLanguage } from "../language/page_words";
import { animationRow, filmRow, takeHomeRow } from "../panels/jobs/take_home";
import { ShareDialog } from "../panels/session/share_dialog";
import { Exports } from "../session/exports";
import type { SessionController } from "../session/session_controller";
import type { Signal } from "../state/signal";
import type { Viewer } from "../viewer/viewer";
import { filmStage } from "./film_stage";
import type { SceneTools } from "./scene_tools";

/** The encoder is loaded with the first film. */
const openWriter: OpenWriter = async (...of) => (await import("../film/film_writer")).FilmWriter.open(...of);

const openAnimation: OpenWriter = async (...of) => (await import("../film/animated_png")).AnimatedPngWriter.open(...of);

/** What the dialog shares of a page. */
interface Shared {
  api: Api;
  sessionId: string;
  controller: SessionController;
  report: Signal<CompileReport | undefined>;
  viewer: Viewer;
  tools: SceneTools;
  /** Names of the session's bodies. */
  names(): string[];
  /** Shows the frame of a film that is drawn; undefined after the last. */
  showFilmed(frame: DisplayedFrame | undefined): void;
  /** Reloads the page with this query string. */
  open(query: string): void;
  /** Saves a picture of the view. */
  photograph(): void;
}

/** Returns the dialog that shares a session: links, a picture, a page to take home, a film and an animated picture. */
export function shareDialog(shared: Shared): ShareDialog {
  const { api, sessionId, controller, report, viewer, tools, names, showFilmed, open, photograph } = shared;
  const stage = filmStage(viewer, tools.coloring, showFilmed);
  const breath = () => recordedMotion(new Exports(api, sessionId), names);
  const film = new FilmMaker(breath(), stage, openWriter);
  const animation = FilmMaker.ofAnimations(breath(), stage, openAnimation);
  const translated = new Exports(api, sessionId, undefined, inPageLanguage);
  const rows = [takeHomeRow(translated), filmRow(film), animationRow(animation)];
  const measured = () => tools.measuring.measurements.kept();
  return new ShareDialog({ controller, report, open, photograph, rows, measured });
}
