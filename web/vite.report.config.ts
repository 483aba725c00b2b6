import { createHash } from "node:crypto";
import { defineConfig, type Plugin } from "vite";

const place = "__PHRENIC_STUDY__";

// Allows only this page's script; plots need inline styles.
const policy = (hash: string) =>
  [
    "default-src 'none'",
    `script-src 'sha256-${hash}'`,
    "style-src 'unsafe-inline'",
    "img-src data:",
    "base-uri 'none'",
    "form-action 'none'",
  ].join("; ");

// Inlines the script and the styles, so that the page is a single file.
function oneFile(): Plugin {
  return {
    name: "one-file",
    apply: "build",
    enforce: "post",
    generateBundle(_, bundle) {
      const page = bundle["report.html"];
      if (page?.type !== "asset") throw new Error("There is no report.html to put everything into.");
      let html = String(page.source)
        .replace(/\s*<link rel="stylesheet"[^>]*>/, "")
        .replace(/\s*<script type="module"[^>]*><\/script>/, "");
      let head = "";
      for (const [name, file] of Object.entries(bundle)) {
        if (file === page) continue;
        delete bundle[name];
        if (file.type === "asset") {
          head += `<style>${String(file.source)}</style>\n`;
          continue;
        }
        const script = file.code.replaceAll("\r", "").replaceAll("</script", "<\\/script").replaceAll("<!--", "<\\!--");
        const hash = createHash("sha256").update(script).digest("base64");
        head = `<meta http-equiv="Content-Security-Policy" content="${policy(hash)}" />\n${head}`;
        head += `<script type="module">${script}</script>\n`;
      }
      html = html.replace("</head>", () => `${head}</head>`);
      if (html.split(place).length !== 2) throw new Error(`report.html must say ${place} once: a study goes there.`);
      page.source = html;
    },
  };
}

// The page that shows one study: dist/report.html, beside the viewer.
export default defineConfig({
  base: "./",
  plugins: [oneFile()],
  build: {
    target: "es2022",
    modulePreload: false,
    cssCodeSplit: false,
    emptyOutDir: false,
    copyPublicDir: false,
    rollupOptions: { input: "report.html" },
  },
});
