/** A module with one function that returns a vector: valid where WebAssembly has SIMD. */
const simdProbe = Uint8Array.from([
  ...[0, 0x61, 0x73, 0x6d, 1, 0, 0, 0], // the head
  ...[1, 5, 1, 0x60, 0, 1, 0x7b], // a type: () -> v128
  ...[3, 2, 1, 0], // a function of it
  ...[10, 10, 1, 8, 0, 0x41, 0, 0xfd, 0x0f, 0xfd, 0x62, 0x0b], // i32.const 0, i8x16.splat, i8x16.popcnt
]);

/** Fetches and compiles the decoder: the one with SIMD where the browser has that. */
export async function loadDecoder(): Promise<WebAssembly.Module> {
  const url = WebAssembly.validate(simdProbe)
    ? new URL("./simd.wasm", import.meta.url)
    : new URL("./plain.wasm", import.meta.url);
  const answer = await fetch(url);
  if (!answer.ok) throw new Error(`${url.pathname} cannot be loaded (HTTP ${answer.status})`);
  return WebAssembly.compile(await answer.arrayBuffer());
}
