/** Messages of a language by their English text. */
export type Messages = Readonly<Record<string, string>>;

let messages: Messages = {};
let decimalSign = ".";
let nounsHaveCapitals = false;

/** Sets the messages of `t`, and the tag of the language whose decimal sign `decimal` writes. */
export function useMessages(all: Messages, tag: string): void {
  messages = all;
  const parts = new Intl.NumberFormat(tag).formatToParts(0.5);
  nounsHaveCapitals = tag.startsWith("de");
  decimalSign = parts.find(({ type }) => type === "decimal")?.value ?? ".";
}

/** Returns the messages that are set. */
export function usedMessages(): Messages {
  return messages;
}

/**
 * Returns the text of the page's language for an English one, with `values` for "{0}", "{1}" ...; the English text if
 * the language has none. What follows " |" in the English text is not shown: it tells texts with two meanings apart.
 */
export function t(english: string, ...values: (string | number)[]): string {
  const text = messages[english] ?? english.split(" |", 1)[0];
  return values.length === 0 ? text : text.replace(/\{(\d)\}/g, (_, i: string) => String(values[Number(i)]));
}

/** Returns a formatted number, or a text with one, with the decimal sign of the language. */
export function decimal(formatted: string): string {
  return formatted.replace(".", decimalSign);
}

/** Returns a number with this many decimals, as the language writes it. */
export function fixed(value: number, digits: number): string {
  return decimal(value.toFixed(digits));
}

/** Returns a name for use within a sentence: in lower case, but German nouns keep their capital. */
export function lower(name: string): string {
  return nounsHaveCapitals ? name : name.toLowerCase();
}

/** Returns a sentence as it stands after a colon: a German one keeps its capital. */
export function afterColon(sentence: string): string {
  return nounsHaveCapitals ? sentence : sentence.charAt(0).toLowerCase() + sentence.slice(1);
}
