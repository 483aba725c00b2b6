import { readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import ts from "typescript";
import terminology from "../../../web/src/anatomy/terminology.json";

const web = join(import.meta.dirname, "../../../web");
const source = join(web, "src");

/** Tables whose texts are translated where they are shown: names of constants by file. */
const tables: Record<string, string[]> = {
  "app/shortcuts.ts": ["pointerGestures"],
  "appearance/fields.ts": ["fields", "tissueFields"],
  "film/caption.ts": ["disclaimer"],
  "fluoroscopy/attenuation.ts": ["materials"],
  "fluoroscopy/c_arm.ts": ["standardProjections"],
  "fluoroscopy/controls.ts": ["distances"],
  "fluoroscopy/explanation.ts": ["texts", "sources"],
  "fluoroscopy/sniff_test.ts": ["words", "both", "one"],
  "graphs/catalogue.ts": ["domeHelp", "probeHelp", "ribCage", "campbellHelp"],
  "graphs/motion_words.ts": ["words", "rise", "fall"],
  "graphs/student_graphs.ts": ["help", "words"],
  "panels/jobs/export_panel.ts": ["valueNames"],
  "panels/jobs/export_progress.ts": ["verbs"],
  "panels/jobs/studies_panel.ts": ["kinds"],
  "panels/jobs/take_home.ts": ["filmTitle", "animationTitle"],
  "panels/readings/m_mode_pictures.ts": ["help"],
  "panels/session/banners.ts": ["halvingHelp"],
  "panels/session/compile_report.ts": ["numbers"],
  "panels/session/connection_badge.ts": ["rateTitle"],
  "panels/session/encoding_panel.ts": ["encodings"],
  "panels/student/lesson_test.ts": ["words"],
  "panels/student/prediction_pad.ts": ["hint"],
  "panels/view/appearance_panel.ts": ["overlayRows", "ghosts", "options"],
  "panels/view/cut_rows.ts": ["kinds"],
  "panels/view/force_table.ts": ["heads"],
  "panels/view/measure_panel.ts": ["tools"],
  "panels/view/orientation_cube.ts": ["sides"],
  "panels/view/pick_card.ts": ["heads"],
  "panels/view/playback.ts": ["speeds"],
  "panels/view/quality_row.ts": ["labels"],
  "panels/view/readout.ts": ["fields"],
  "panels/view/tissue_card.ts": ["heads", "help"],
  "panels/view/view_bar.ts": ["buttons"],
  "panels/comparison/view_headers.ts": ["words"],
  "panels/readings/probes.ts": ["heads"],
  "patient/finding_words.ts": ["sides"],
  "patient/patient_dialog.ts": ["verdicts"],
  "viewer/viewpoints.ts": ["directions", "cuts"],
};

/** Properties whose texts are translated where they are shown. */
const properties: Record<string, string[]> = {
  "app/app_shortcuts.ts": ["description"],
  "app/shortcuts.ts": ["description"],
  "body/body_numbers.ts": ["title", "label"],
  "graphs/catalogue.ts": ["title"],
  "graphs/student_graphs.ts": ["title"],
};

/** Texts of tables that look like names of the program, and texts that are composed. */
const others = [
  ..."right left on off above below muscle air parallel default positions displacements vertices springs attachments fastest".split(
    " ",
  ),
  ..."time tick breath pace links dome distance angle area volume".split(" "),
  ..."upper lower front back wall".split(" "),
  ..."Space Healthy Ill Machine Breaths Supine Upright Prone".split(" "),
  ..."Flows Pressures Heights Energies".split(" "),
  ..."Female Male".split(" "),
  ...["right dome", "left dome", "Right side", "Left side"],
  ...["right summit", "left summit", "sternum", "rib 8 right", "rib 8 left"],
  ...["PAGEDOWN", "PAGEUP", "ESCAPE"],
];

/** True for a text that has a word: neither a symbol nor a name of the program. */
const isSentence = (text: string) => /\p{L}{2}/u.test(text) && /^[^\p{L}]*\p{Lu}| /u.test(text);

function files(folder: string): string[] {
  return readdirSync(join(source, folder), { withFileTypes: true }).flatMap((entry) => {
    const path = folder === "" ? entry.name : `${folder}/${entry.name}`;
    if (entry.isDirectory()) return entry.name === "gen" || entry.name === "report" ? [] : files(path);
    return entry.name.endsWith(".ts") ? [path] : [];
  });
}

/** Returns the texts that an expression may have; empty for one that is computed. */
function textsOf(node: ts.Node): string[] {
  if (ts.isStringLiteral(node) || ts.isNoSubstitutionTemplateLiteral(node)) return [node.text];
  if (ts.isConditionalExpression(node)) return [...textsOf(node.whenTrue), ...textsOf(node.whenFalse)];
  if (ts.isParenthesizedExpression(node)) return textsOf(node.expression);
  return [];
}

/** Returns all texts below a node that look like words of a sentence or a name. */
function allTexts(node: ts.Node): string[] {
  const own = ts.isStringLiteral(node) ? [node.text] : [];
  const below: string[] = [];
  ts.forEachChild(node, (child) => void below.push(...allTexts(child)));
  return [...own, ...below].filter(isSentence);
}

function fromSource(path: string): string[] {
  const file = ts.createSourceFile(path, readFileSync(join(source, path), "utf8"), ts.ScriptTarget.Latest, true);
  const found: string[] = [];
  const visit = (node: ts.Node) => {
    if (ts.isCallExpression(node) && node.expression.getText() === "t") found.push(...textsOf(node.arguments[0]));
    if (ts.isVariableDeclaration(node) && node.initializer && tables[path]?.includes(node.name.getText()))
      found.push(...allTexts(node.initializer));
    if (ts.isPropertyAssignment(node) && properties[path]?.includes(node.name.getText()))
      found.push(...textsOf(node.initializer));
    ts.forEachChild(node, visit);
  };
  visit(file);
  return found;
}

function fromPage(name: string): string[] {
  const html = readFileSync(join(web, name), "utf8").replace(
    /<head>.*<\/head>|<noscript>.*?<\/noscript>|<script.*?<\/script>/gs,
    "",
  );
  const spoken = [...html.matchAll(/(?:title|aria-label)="(.*?)"/g)].map(([, text]) => text);
  return [...spoken, ...[...html.matchAll(/>([^<]+)</g)].map(([, text]) => text.trim())].filter(
    (text) => text !== "Phrenic",
  );
}

/** Returns the texts of the scenes: titles, presets, layers and measures. */
function fromScenes(): string[] {
  const folder = join(web, "../server/scenes");
  const scenes = readdirSync(folder).filter((name) => name.endsWith(".textproto"));
  return scenes.flatMap((name) => {
    const scene = readFileSync(join(folder, name), "utf8");
    const texts = [...scene.matchAll(/\b(?:title|description|group): "((?:[^"\\]|\\.)*)"/g)].map(([, text]) => text);
    const measures = [...scene.matchAll(/^measures { name: "(.*?)"/gm)].map(([, measure]) => measure);
    return [...texts, ...measures].map((text) => text.replaceAll("\\'", "'"));
  });
}

/** Returns the names and explanations of the live parameters and of the numbers of a body. */
function fromParameters(): string[] {
  const read = (name: string) => readFileSync(join(web, `../proto/phrenic/v1/${name}.proto`), "utf8");
  const proto = read("parameters") + read("geometry").split("message Physique")[1];
  return [...proto.matchAll(/(?:\blabel|\bhelp|\(group\))\s*[:=]\s*((?:"[^"]*"\s*)+)/g)].map(([, quoted]) =>
    [...quoted.matchAll(/"([^"]*)"/g)].map(([, part]) => part).join(""),
  );
}

/** Returns the titles of the example bodies. */
function fromBodies(): string[] {
  const lines = readFileSync(join(web, "../client/examples/bodies.txt"), "utf8").split("\n");
  return lines.filter((line) => line !== "" && !line.startsWith("#")).map((line) => line.split(":")[0]);
}

function fromTerminology(): string[] {
  return terminology.structures.flatMap(({ name, definitions }) => [name, ...Object.values(definitions)]);
}

/** Returns every English text that a catalogue must translate. */
export function keysOfSources(): Set<string> {
  const all = [
    ...files("").flatMap(fromSource),
    ...fromPage("index.html"),
    ...fromPage("offline.html"),
    ...fromScenes(),
    ...fromParameters(),
    ...fromBodies(),
    ...fromTerminology(),
    ...others,
  ];
  return new Set(all.filter((text) => /\p{L}{2}/u.test(text)));
}
