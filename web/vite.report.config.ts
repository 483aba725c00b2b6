import { defineConfig } from "vite";
import { oneFilePage } from "./one_file";

// The page that shows one study: dist/report.html.
export default defineConfig(oneFilePage("report.html", "__PHRENIC_STUDY__"));
