import url from "./plain.wasm?inline";

/** Compiles the decoder that is part of the script, for pages that load nothing; it runs without SIMD too. */
export function embeddedDecoder(): Promise<WebAssembly.Module> {
  const text = atob(url.slice(url.indexOf(",") + 1));
  return WebAssembly.compile(Uint8Array.from(text, (letter) => letter.charCodeAt(0)));
}
