/** Words in file names that say what a file shows: structures, sides, programs and models. */
const known =
  /^(ribs?|left|right|l|r|lungs?|upper|middle|lower|lobe|vertebrae?|vertebralbody|[tl]\d{1,2}|th\d{1,2}|thoracic|lumbar|liver|spleen|stomach|heart|atrium|ventricle|myocardium|sternum|manubrium|costal|cartilages?|diaphragm|organs|cardiac|55\d|\d{1,2})$/;

/**
 * Returns the words of a file's name that say what it shows, and none that may identify the person: "rib left 7" of
 * "DOE^JANE_rib_left_7.nii.gz". A number counts only beside a word.
 */
export function structureWords(fileName: string): string {
  const stem = fileName
    .toLowerCase()
    .replace(/\.(nii|gz|dcm)/g, " ")
    .replace(/([a-z]{3})(\d)/g, "$1 $2");
  const words = stem.split(/[^a-z0-9]+/).map((word) => (known.test(word) ? word : ""));
  const numeric = (word: string) => /^\d/.test(word) && !/^55\d$/.test(word);
  const beside = (i: number) => [words[i - 1], words[i + 1]].some((word) => word && !numeric(word));
  return words.filter((word, i) => word !== "" && (!numeric(word) || beside(i))).join(" ");
}

/**
 * Returns names for the files of one patient, which differ and tell the server what they show: "fa rib left 7". The
 * first word is the place among the files.
 */
export function neutralNames(fileNames: string[]): string[] {
  return fileNames.map((name, i) => `f${letters(i)} ${structureWords(name)}`.trim());
}

/** Returns 0 as "aa", 1 as "ab", 26 as "ba". */
function letters(i: number): string {
  return String.fromCharCode(97 + Math.floor(i / 26), 97 + (i % 26));
}
