import type { Parameters } from "../gen/phrenic/v1/parameters_pb";
import { parameterControls } from "./controls";
import { formatNumber } from "./numbers";
import { decimal, lower, t } from "../language/translate";

interface Difference {
  label: string;
  here: string;
  there: string;
}

function differingParameters(here: Parameters | undefined, there: Parameters | undefined): Difference[] {
  if (here === undefined || there === undefined) return [];
  const values = (of: Parameters) => of as unknown as Record<string, number | boolean>;
  return parameterControls()
    .filter(({ field }) => values(here)[field] !== values(there)[field])
    .map((control) => {
      const words = (value: number | boolean) => {
        if (typeof value === "boolean") return t(value ? "on" : "off");
        const named = control.kind === "choice" ? control.options.find((each) => each.value === value) : undefined;
        return named === undefined ? decimal(formatNumber(value)) : t(named.label);
      };
      const { field, label } = control;
      return { label: t(label), here: words(values(here)[field]), there: words(values(there)[field]) };
    });
}

/** Returns how the parameters `there` differ from those `here`: "Breath force 2 instead of 1". */
export function differences(here: Parameters | undefined, there: Parameters | undefined): string {
  return differingParameters(here, there)
    .map(({ label, here, there }) => t("{0} {1} instead of {2}", label, there, here))
    .join(", ");
}

/** Returns the same, or "With breath force 0.45, breath length 3, rib motion 1.5" for more than two differences. */
export function shortDifferences(here: Parameters | undefined, there: Parameters | undefined): string {
  const all = differingParameters(here, there);
  if (all.length < 3) return differences(here, there);
  return t("With {0}", all.map(({ label, there }) => `${lower(label)} ${there}`).join(", "));
}
