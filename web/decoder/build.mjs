// Compiles the server's decoder of frames (../../server/stream/decoder) to WebAssembly: src/decoders/simd.wasm, and
// plain.wasm for browsers without SIMD, with zstd's own sources, which the npm package zstd-napi has. Does nothing if both
// are newer than their sources.
import { spawnSync } from "node:child_process";
import { existsSync, mkdtempSync, readdirSync, rmSync, statSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, join, resolve } from "node:path";

const packages = "binaryen clang-14 libc++-14-dev-wasm32 libclang-rt-14-dev-wasm32 lld-14 wasi-libc";
const root = resolve(import.meta.dirname, "../..");
const sources = join(root, "server/stream/decoder");
const out = join(root, "web/src/decoders");
const zstd = join(root, "web/node_modules/zstd-napi/deps/zstd/lib");
const exported = [
  "allocate",
  "release",
  "decompressed_size",
  "decompress",
  ...["make", "set_basis", "decode", "free"].map((name) => `decoder_${name}`),
].map((name) => `phrenic_${name}`);

// No library throws, and the C library is that of WASI, of which nothing that calls the system is used: no imports.
const target = ["--target=wasm32-wasi"];
const compiling = [
  ...["-std=c++20", "-O3", "-ffp-contract=off", "-Wall", "-Wextra", "-Werror", "-I", root, "-isystem", zstd],
  ...["-fno-exceptions", "-fno-rtti", "-fno-threadsafe-statics", "-fvisibility=hidden", "-ffunction-sections"],
];
// The small one of zstd's two ways to decode literals and sequences; messages of errors as numbers.
const compilingZstd = [
  ...["-Os", "-fvisibility=hidden", "-ffunction-sections", "-DZSTD_LEGACY_SUPPORT=0", "-DZSTD_TRACE=0"],
  ...["-DZSTD_STRIP_ERROR_STRINGS=1", "-DHUF_FORCE_DECOMPRESS_X1=1", "-DZSTD_FORCE_DECOMPRESS_SEQUENCES_SHORT=1"],
];
const linking = [
  ...["-nostartfiles", "-fuse-ld=lld"],
  `-Wl,--no-entry,--gc-sections,--strip-all,-z,stack-size=65536,--max-memory=${2 ** 30}`,
  ...exported.map((name) => `-Wl,--export=${name}`),
];

/** Returns the paths of the files of these kinds in a folder. */
function filesIn(folder, ...kinds) {
  const names = readdirSync(folder).filter((name) => kinds.some((kind) => name.endsWith(kind)));
  return names.map((name) => join(folder, name));
}

/** Ends with what is missing and the remedy. */
function fail(what) {
  console.error(`phrenic: ${what}\nOn Debian 12: apt-get install --no-install-recommends ${packages}`);
  process.exit(1);
}

/** Runs a tool; ends if it is missing or fails. */
function run(tool, args) {
  const { error, status } = spawnSync(tool, args, { stdio: ["ignore", "inherit", "inherit"] });
  if (error !== undefined) fail(`the viewer's decoder needs ${tool}, which cannot be started (${error.code}).`);
  if (status !== 0) fail(`${tool} failed (above); if it misses a header or a library, install these packages.`);
}

/** Compiles `files` to NAME.wasm. */
function build(name, files, simd) {
  const folder = mkdtempSync(join(tmpdir(), "phrenic-decoder-"));
  try {
    const objects = files.map((file) => {
      const object = join(folder, `${basename(file)}.o`);
      const [compiler, options] = file.endsWith(".c") ? ["clang-14", compilingZstd] : ["clang++-14", compiling];
      run(compiler, [...target, ...options, ...(simd ? ["-msimd128"] : []), "-c", file, "-o", object]);
      return object;
    });
    const linked = join(folder, "linked.wasm");
    // Without -O: clang then leaves wasm-opt to the next line, which allows SIMD.
    run("clang++-14", [...target, ...linking, ...objects, "-o", linked]);
    const features = simd ? ["--enable-simd"] : [];
    run("wasm-opt", ["-O3", ...features, linked, "-o", join(out, `${name}.wasm`)]);
  } finally {
    rmSync(folder, { recursive: true });
  }
}

const here = import.meta.dirname;
if (!existsSync(zstd)) {
  console.error(`phrenic: zstd's sources are missing from web/node_modules: run npm ci in web.`);
  process.exit(1);
}
const withoutThreads = filesIn(join(zstd, "common"), ".c").filter((file) => !/(pool|threading)\.c$/.test(file));
const library = [...withoutThreads, ...filesIn(join(zstd, "decompress"), ".c")];
const files = [...filesIn(sources, ".cc"), ...filesIn(here, ".cc"), ...library].sort();
const made = ["simd", "plain"].map((name) => join(out, `${name}.wasm`));
const changed = Math.max(
  ...[...files, ...filesIn(sources, ".h"), ...filesIn(here, ".mjs")].map((file) => statSync(file).mtimeMs),
);
if (!made.every((file) => existsSync(file) && statSync(file).mtimeMs > changed)) {
  build("simd", files, true);
  build("plain", files, false);
}
