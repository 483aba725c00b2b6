import { make } from "../dom/elements";
import { lungDensityAtRest, materials } from "./attenuation";
import { decimal, fixed, t } from "../language/translate";

/**
 * Returns what the picture is made of, its numbers and their sources, and its limits. `open` names bodies that are left
 * out.
 */
export function explanation(open: string[]): HTMLElement[] {
  const rows = Object.values(materials).map(({ words, coefficient }) => {
    return make("tr", {}, make("th", { scope: "row" }, t(words)), make("td", {}, fixed(coefficient, 1)));
  });
  const head = make("tr", {}, make("th", { scope: "col" }, t("Material")), make("th", { scope: "col" }, "1/m"));
  const left = open.length === 0 ? "" : t(" Left out, since their surfaces are open: {0}.", open.join(", "));
  const texts = [
    "Each ray is weakened to exp(−Σ μ t): attenuation coefficient μ times thickness t of all that it passes, at 70 keV. Grey is the logarithm of that, linear within the window, as film and detectors show it.",
    "The scene has no skin. An outline of the trunk is drawn 18 mm around the bones and filled with soft tissue; each structure inside of it replaces that tissue, so nothing counts twice. Between lungs and outline is chest wall; arms, shoulder blades, breasts, bowel gas and vessels of the lungs are missing.",
    "A lung has {0} g/cm³ of tissue and blood at rest. That mass stays while its volume changes: a deep breath makes lungs darker. Air and fluid around a lung, which the scene's parameters can set, have no surface and are not seen.",
    "Scattered rays, noise and the spectrum of a tube are not computed: contrast is higher than in a patient.",
  ];
  const sources =
    "Coefficients: Hubbell and Seltzer, NIST SRD 126, tissues of ICRU 44; densities of bones: ICRU 46. Limits of a sniff: Boussuges et al., Chest 2009;135:391; Alexander, Clin Radiol 1966;17:79.";
  const table = make("table", {}, make("thead", {}, head), make("tbody", {}, ...rows));
  return [...texts.map((text) => t(text, decimal(String(lungDensityAtRest)))), t(sources) + left]
    .map((text) => make("p", {}, text) as HTMLElement)
    .concat(table);
}
