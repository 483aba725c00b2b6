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

// Writes the descriptors of the protobuf files as text, which the browser encodes in base64: only in text does Brotli find
// the names that they share with each other and with the code.
function textDescriptors(): Plugin {
  return {
    name: "text-descriptors",
    apply: "build",
    transform: {
      order: "pre",
      filter: { id: /\/src\/gen\/.*_pb\.ts$/ },
      handler(code, id) {
        const parts = /^([^]*fileDesc\()"([A-Za-z0-9+/=]+)"([^]*)$/.exec(code);
        if (parts === null) throw new Error(`${id} has no descriptor in base64: has protoc-gen-es changed?`);
        const text = Buffer.from(parts[2], "base64").toString("latin1");
        return { code: `${parts[1]}/* @__PURE__ */ btoa(${JSON.stringify(text)})${parts[3]}`, map: null };
      },
    },
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
  plugins: [contentSecurityPolicy(), textDescriptors(), compressed()],
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
