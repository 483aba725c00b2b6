import { loadDecoder } from "../decoders/load_decoder";
import { motionText, readMotion } from "../frames/clip";
import type { Exports } from "../session/exports";
import type { MotionSource } from "./film_maker";

/**
 * Returns the next breath of a session, which the server records as for a page. `exports` belongs to the source.
 * `bodies` returns the names of all bodies of the session: the frames then have the session's numbers of bodies and
 * vertices, as the view that draws them.
 */
export function recordedMotion(exports: Exports, bodies: () => string[], decoder = loadDecoder): MotionSource {
  return {
    progress: exports.progress,
    decoder,
    record: async () => {
      exports.choose({ format: "html", seconds: 0, bodies: bodies() });
      const page = await exports.start();
      return page && readMotion(await decoder(), motionText(await page.text()));
    },
    stop: () => exports.stop(),
  };
}
