import { make } from "../../dom/elements";
import { labelledRow, section } from "../../dom/rows";
import { Codec } from "../../gen/phrenic/v1/frames_pb";
import { t } from "../../language/translate";

const encodings: [Codec, string, string][] = [
  [Codec.PREDICTED, "Predicted from neighbours", "About 13 kB per frame of the thorax; needs only the scene."],
  [Codec.BASIS, "Basis of shapes", "About 100 bytes per frame after one breath; the basis is downloaded once."],
  [Codec.PLANES, "16 bits per coordinate", "Can be decoded without the mesh."],
  [Codec.RAW, "Uncompressed", "Exact float32, for comparisons on a fast connection."],
];

/** Selects the encoding of frames for this viewer. */
export function encodingPanel(choose: (codec: Codec) => void): HTMLElement {
  const list = make("select", { id: "stream-codec", title: t("Encoding of frames on the network") });
  list.append(
    ...encodings.map(([codec, label, title]) => make("option", { value: String(codec), title: t(title) }, t(label))),
  );
  const hint = make("p", { className: "faint", id: "stream-hint" });
  const show = () => (hint.textContent = t(encodings.find(([codec]) => codec === Number(list.value))?.[2] ?? ""));
  list.onchange = () => {
    show();
    choose(Number(list.value));
  };
  show();
  const row = labelledRow("stream-codec", t("Frame encoding"), list);
  row.classList.add("wide");
  return section(t("Streaming"), false, row, hint);
}
