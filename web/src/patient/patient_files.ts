/** What is dropped on the page: files, and the folders among them. */
export interface Dropped {
  files: File[];
  entries: FileSystemEntry[];
}

/** What the files of a folder are. */
export interface FoundFiles {
  /** Files that may hold labels: DICOM Segmentations, RT Structure Sets, NIfTI files, and archives of them. */
  volumes: File[];
  /** Archives and compressed files that are not read, at most ten: they must be unpacked. */
  unread: File[];
  /** Number of other DICOM files, such as the slices of a CT, which are not needed and not sent. */
  images: number;
  /** Number of all other files. */
  others: number;
}

type FileKind = "volume" | "unread" | "image" | "other";

/** SOP classes of Segmentation, Label Map Segmentation and RT Structure Set (DICOM PS3.4, B.5). */
const labelClasses = /1\.2\.840\.10008\.5\.1\.4\.1\.1\.(66\.4|66\.7|481\.3)\0/;
/** The meta information of a DICOM file, which names its class, is at its start [bytes]. */
const headBytes = 2048;
/** Files of a folder that are looked at. */
const mostFiles = 20_000;
const mostUnread = 10;
/** First bytes of 7-Zip, RAR, xz, bzip2 and Zstandard. */
const unreadMarks = /^(7z\xbc\xaf\x27\x1c|Rar!\x1a\x07|\xfd7zXZ|BZh|\x28\xb5\x2f\xfd)/;

/** Returns what the files are, by their first bytes. */
export async function findVolumes(files: File[]): Promise<FoundFiles> {
  const found: FoundFiles = { volumes: [], unread: [], images: 0, others: 0 };
  for (const file of files) {
    const kind = await kindOf(file);
    if (kind === "volume") found.volumes.push(file);
    else if (kind === "image") found.images++;
    else {
      found.others++;
      if (kind === "unread" && found.unread.length < mostUnread) found.unread.push(file);
    }
  }
  return found;
}

async function kindOf(file: File): Promise<FileKind> {
  const head = new Uint8Array(await file.slice(0, headBytes).arrayBuffer());
  const text = new TextDecoder("latin1").decode(head);
  // A UID of odd length is padded by a zero; one of even length is followed by the next tag, whose group is 0002.
  if (text.slice(128, 132) === "DICM") return labelClasses.test(text.replaceAll("\x02", "\0")) ? "volume" : "image";
  const isGzip = head[0] === 0x1f && head[1] === 0x8b;
  const isNifti = /^(n\+1|ni1|n\+2)/.test(text.slice(344)) || /^n\+2/.test(text.slice(4));
  const isArchive = text.startsWith("PK\x03\x04") || text.slice(257, 262) === "ustar";
  if (isNifti || isArchive || (isGzip && /\.nii\.gz$/i.test(file.name))) return "volume";
  return unreadMarks.test(text) || (isGzip && /\.(tar\.gz|tgz)$/i.test(file.name)) ? "unread" : "other";
}

/** Returns the files of what was dropped, also those in folders. */
export async function droppedFiles({ entries, files }: Dropped): Promise<File[]> {
  if (!entries.some((entry) => entry.isDirectory)) return files;
  const found: File[] = [];
  for (const entry of entries) await addFiles(entry, found);
  return found;
}

async function addFiles(entry: FileSystemEntry, found: File[]): Promise<void> {
  if (found.length >= mostFiles) return;
  if (entry.isFile) {
    found.push(await new Promise<File>((done, fail) => (entry as FileSystemFileEntry).file(done, fail)));
    return;
  }
  const reader = (entry as FileSystemDirectoryEntry).createReader();
  const next = () => new Promise<FileSystemEntry[]>((done, fail) => reader.readEntries(done, fail));
  // A reader gives some entries at a time, and none at the end.
  for (let some = await next(); some.length > 0; some = await next()) {
    for (const each of some) await addFiles(each, found);
  }
}
