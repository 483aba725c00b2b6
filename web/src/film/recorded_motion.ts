import { loadDecoder } from "../decoders/load_decoder";
import { motionText, readMotion } from "../frames/clip";
import type { Exports } from "../session/exports";
import type { MotionSource } from "./film_maker";

/** Returns the next breath of a session, which the server records as for a page. `exports` belongs to the source. */
export function recordedMotion(exports: Exports, decoder = loadDecoder): MotionSource {
  exports.choose({ format: "html", seconds: 0, bodies: [] });
  return {
    progress: exports.progress,
    decoder,
    record: async () => {
      const page = await exports.start();
      return page && readMotion(await decoder(), motionText(await page.text()));
    },
    stop: () => exports.stop(),
  };
}
