import type { Coloring } from "../appearance/coloring";
import { fieldInfo, forceKindOf, tissueKindOf } from "../appearance/fields";
import type { FilmStage } from "../film/pictures";
import type { DisplayedFrame } from "../frames/frame_buffer";
import { pictureBackground, type Viewer } from "../viewer/viewer";
import { t } from "../language/translate";

/**
 * Returns the viewer as the stage of a film. `show` sets the frame that the viewer's host displays; undefined: the live
 * one. `coloring` is undefined on a page without colours.
 */
export function filmStage(
  viewer: Viewer,
  coloring: Coloring | undefined,
  show: (frame: DisplayedFrame | undefined) => void,
): FilmStage {
  return {
    background: pictureBackground,
    refusal: () => {
      const kind = coloring?.field.value;
      if (forceKindOf(kind) === undefined && tissueKindOf(kind) === undefined) return undefined;
      return t("A recorded breath has no forces and no lung tissue: choose another field for the colours.");
    },
    colors: () => {
      const [info, scale] = [fieldInfo(coloring?.field.value), coloring?.scale.value];
      return info === undefined || scale === undefined ? undefined : { label: t(info.label), scale };
    },
    area: () => viewer.freeArea,
    begin: (ratio) => viewer.beginFilm(ratio),
    draw: (frame) => {
      show(frame);
      return viewer.drawForFilm();
    },
    end: () => {
      show(undefined);
      viewer.endFilm();
    },
  };
}
