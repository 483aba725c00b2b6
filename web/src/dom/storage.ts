type Kept = Pick<Storage, "getItem" | "setItem">;

/**
 * Returns what the browser keeps, or a store of this page alone where it keeps nothing: in a frame of another site's
 * page, browsers that refuse the storage of third parties throw.
 */
export function storageOr(storage: () => Kept): Kept {
  try {
    storage().getItem("");
    return storage();
  } catch {
    const kept = new Map<string, string>();
    return { getItem: (key) => kept.get(key) ?? null, setItem: (key, value) => void kept.set(key, value) };
  }
}

/** What this browser remembers. */
export const ownStorage = storageOr(() => localStorage);
/** What this tab remembers. */
export const tabStorage = storageOr(() => sessionStorage);
