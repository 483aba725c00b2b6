import { readFileSync } from "node:fs";
import { join } from "node:path";

/** Both builds of the decoder, by name, which `npm run generate` makes. */
export const decoderModules = new Map(
  ["simd", "plain"].map((name) => {
    const bytes = readFileSync(join(import.meta.dirname, "../../../web/src/decoders", `${name}.wasm`));
    return [name, new WebAssembly.Module(bytes)];
  }),
);

/** The build that most browsers load. */
export function decoderModule(): WebAssembly.Module {
  return decoderModules.get("simd")!;
}
