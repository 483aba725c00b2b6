import { make } from "../../dom/elements";
import { section } from "../../dom/rows";
import { Codec } from "../../gen/phrenic/v1/frames_pb";

const encodings: [Codec, string, string][] = [
  [Codec.PREDICTED, "Foretold from neighbours", "About 13 kB a frame of the thorax; needs nothing but the scene."],
  [Codec.BASIS, "Shapes that were seen", "Some 100 bytes a frame once a breath was seen; the shapes are fetched once."],
  [Codec.PLANES, "16 bits a coordinate", "Needs no knowledge of the mesh to decode."],
  [Codec.RAW, "As they are", "Every bit of float32: for comparing, on a good line."],
];

/** Selects the encoding of frames for this viewer. */
export function encodingPanel(choose: (codec: Codec) => void): HTMLElement {
  const list = make("select", { id: "stream-codec", title: "How frames come over the line" });
  list.append(...encodings.map(([codec, label, title]) => make("option", { value: String(codec), title }, label)));
  const hint = make("p", { className: "faint", id: "stream-hint" });
  const show = () => (hint.textContent = encodings.find(([codec]) => codec === Number(list.value))?.[2] ?? "");
  list.onchange = () => {
    show();
    choose(Number(list.value));
  };
  show();
  const row = make(
    "div",
    { className: "compare-row wide" },
    make("label", { htmlFor: "stream-codec" }, "Frames"),
    list,
  );
  return section("Stream", false, row, hint);
}
