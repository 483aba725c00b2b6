import { readFileSync, writeFileSync } from "node:fs";
import { brotliCompressSync, constants, gzipSync } from "node:zlib";
import { defineConfig, type Plugin } from "vite";

const policy = [
  "default-src 'none'",
  "script-src 'self' 'wasm-unsafe-eval'",
  "style-src 'self'",
  "img-src 'self' data: blob:",
  "connect-src 'self'",
  "base-uri 'none'",
  "form-action 'none'",
].join("; ");

// The built page has a content security policy in its HTML; the development server needs inline styles.
function contentSecurityPolicy(): Plugin {
  return {
    name: "content-security-policy",
    apply: "build",
    transformIndexHtml: () => [
      { tag: "meta", attrs: { "http-equiv": "Content-Security-Policy", content: policy }, injectTo: "head-prepend" },
    ],
  };
}

// Writes each script, style, page and decoder compressed beside itself; phrenicd serves what the browser accepts.
function compressed(): Plugin {
  return {
    name: "compressed",
    apply: "build",
    enforce: "post",
    writeBundle({ dir }, bundle) {
      for (const name of Object.keys(bundle).filter((each) => /\.(js|css|html|wasm)$/.test(each))) {
        const bytes = readFileSync(`${dir}/${name}`);
        writeFileSync(
          `${dir}/${name}.br`,
          brotliCompressSync(bytes, { params: { [constants.BROTLI_PARAM_QUALITY]: constants.BROTLI_MAX_QUALITY } }),
        );
        writeFileSync(`${dir}/${name}.gz`, gzipSync(bytes, { level: 9 }));
      }
    },
  };
}

export default defineConfig({
  plugins: [contentSecurityPolicy(), compressed()],
  build: {
    target: "es2022",
    modulePreload: { polyfill: false },
    assetsInlineLimit: 0,
    // What the first page shares with parts that are loaded later is one file: fewer requests, and smaller together.
    rolldownOptions: { output: { codeSplitting: { groups: [{ name: "shared", tags: ["$initial"] }] } } },
  },
  worker: { format: "es" },
  // `npx vite` serves the sources and forwards calls to a phrenicd at this address.
  server: { proxy: { "^/(phrenic|grpc)\\.": process.env.PHRENIC_WEB ?? "http://127.0.0.1:8080" } },
});
