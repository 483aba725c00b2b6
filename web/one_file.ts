import { createHash } from "node:crypto";
import { readFileSync } from "node:fs";
import type { Plugin, UserConfig } from "vite";

// Allows only this page's script, with or without WebAssembly in it; plots need inline styles.
const policyOf = (webAssembly: boolean) => (hash: string) =>
  [
    "default-src 'none'",
    `script-src 'sha256-${hash}'${webAssembly ? " 'wasm-unsafe-eval'" : ""}`,
    "style-src 'unsafe-inline'",
    "img-src data: blob:",
    "base-uri 'none'",
    "form-action 'none'",
  ].join("; ");

const iconUrl = `data:image/svg+xml;base64,${readFileSync(new URL("public/icon.svg", import.meta.url), "base64")}`;

/** Inlines the script, the styles and the icon, so that the page is a single file. `place` is where its data goes. */
function oneFile(name: string, place: string, policy: (hash: string) => string): Plugin {
  return {
    name: "one-file",
    apply: "build",
    enforce: "post",
    generateBundle(_, bundle) {
      const page = bundle[name];
      if (page?.type !== "asset") throw new Error(`There is no ${name} to put everything into.`);
      let html = String(page.source)
        .replace(/\s*<link rel="stylesheet"[^>]*>/, "")
        .replace(/\s*<script type="module"[^>]*><\/script>/, "");
      let head = "";
      for (const [path, file] of Object.entries(bundle)) {
        if (file === page) continue;
        delete bundle[path];
        if (file.type === "asset") {
          head += `<style>${String(file.source).replaceAll(/url\(["']?[^"')]*icon\.svg["']?\)/g, `url("${iconUrl}")`)}</style>\n`;
          continue;
        }
        const script = file.code.replaceAll("\r", "").replaceAll("</script", "<\\/script").replaceAll("<!--", "<\\!--");
        const hash = createHash("sha256").update(script).digest("base64");
        head = `<meta http-equiv="Content-Security-Policy" content="${policy(hash)}" />\n${head}`;
        head += `<script type="module">${script}</script>\n`;
      }
      html = html.replace("</head>", () => `${head}</head>`);
      if (html.split(place).length !== 2) throw new Error(`${name} must say ${place} once: its data goes there.`);
      page.source = html;
    },
  };
}

/** Returns the configuration that builds a page as one file of dist/, beside the viewer. */
export function oneFilePage(name: string, place: string, webAssembly = false): UserConfig {
  return {
    base: "./",
    assetsInclude: ["**/*.wasm"], // which the script has inside
    plugins: [oneFile(name, place, policyOf(webAssembly))],
    build: {
      target: "es2022",
      modulePreload: false,
      cssCodeSplit: false,
      emptyOutDir: false,
      copyPublicDir: false,
      rollupOptions: { input: name },
    },
  };
}
