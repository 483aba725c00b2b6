import { defineConfig } from "vite";
import { oneFilePage } from "./one_file";

// The page that plays one motion: dist/offline.html.
export default defineConfig(oneFilePage("offline.html", "__PHRENIC_MOTION__", true));
