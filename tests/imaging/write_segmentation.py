#!/usr/bin/python3
# write_segmentation.py NIFTI DICOM [explicit | implicit | big | deflated]: converts a label volume by nibabel and pydicom
# to a DICOM Segmentation as archives hold them: BINARY, frames packed without gaps, without empty ones, shuffled.
# Labels are numbered anew from 1. Ribs and lungs have no SegmentLabel that a label map knows, only codes.
import random
import re
import sys

import nibabel
import numpy
from pydicom import uid
from pydicom.dataset import Dataset, FileDataset, FileMetaDataset
from pydicom.sequence import Sequence

ORDINALS = ("First Second Third Fourth Fifth Sixth Seventh Eighth Ninth Tenth Eleventh Twelfth").split()
SYNTAXES = {
    "explicit": uid.ExplicitVRLittleEndian,
    "implicit": uid.ImplicitVRLittleEndian,
    "big": uid.ExplicitVRBigEndian,
    "deflated": uid.DeflatedExplicitVRLittleEndian,
}


def item(**attributes):
    dataset = Dataset()
    for keyword, value in attributes.items():
        setattr(dataset, keyword, value)
    return dataset


def code(meaning):
    return item(CodeValue="0", CodingSchemeDesignator="99PHRENIC", CodeMeaning=meaning)


def names_of(image):
    text = b"".join(extension.get_content() for extension in image.header.extensions).decode()
    return {int(key): name for key, name in re.findall(r'<Label Key="(\d+)"><!\[CDATA\[(.*?)\]\]>', text)}


def coded(name):
    """The meaning of a label's code and its side, as TotalSegmentator's table of SNOMED codes has them."""
    parts = name.split("_")
    if parts[0] == "rib":
        return ORDINALS[int(parts[2]) - 1] + " rib", parts[1].capitalize()
    if parts[0] == "lung":
        return f"{parts[1].capitalize()} lobe of lung", parts[3].capitalize()
    return None


def segment(number, name):
    known = coded(name)
    kind = code(known[0] if known else "Organ")
    if known:
        kind.SegmentedPropertyTypeModifierCodeSequence = Sequence([code(known[1])])
    return item(
        SegmentNumber=number,
        SegmentLabel=f"Segment {number}" if known else name,
        SegmentAlgorithmType="MANUAL",
        SegmentedPropertyCategoryCodeSequence=Sequence([code("Anatomical structure")]),
        SegmentedPropertyTypeCodeSequence=Sequence([kind]),
    )


def decimals(numbers):
    return [f"{number:.8g}" for number in numbers]


def frame_group(number, position):
    return item(
        PlanePositionSequence=Sequence([item(ImagePositionPatient=decimals(position))]),
        SegmentIdentificationSequence=Sequence([item(ReferencedSegmentNumber=number)]),
    )


def shared_group(frame):
    edges = numpy.linalg.norm(frame[:3, :3], axis=0)
    cosines = frame[:3, :3] / edges
    return item(
        PixelMeasuresSequence=Sequence(
            [item(PixelSpacing=decimals([edges[1], edges[0]]), SliceThickness=decimals(edges[2:])[0])]
        ),
        PlaneOrientationSequence=Sequence(
            [item(ImageOrientationPatient=decimals([*cosines[:, 0], *cosines[:, 1]]))]
        ),
    )


def frames_of(labels, numbers, frame):
    """(segment number, position, pixels) of every slice of every segment that is not empty."""
    for number, label in enumerate(numbers, 1):
        mask = labels == label
        for k in numpy.flatnonzero(mask.any(axis=(0, 1))):
            yield number, (frame @ [0, 0, k, 1])[:3], mask[:, :, k].T


def main():
    image = nibabel.load(sys.argv[1])
    syntax = SYNTAXES[sys.argv[3] if len(sys.argv) > 3 else "explicit"]
    labels = numpy.asarray(image.dataobj)
    frame = numpy.diag([-1, -1, 1, 1]) @ image.affine  # RAS to LPS
    names = names_of(image)
    numbers = [int(label) for label in numpy.unique(labels) if label]
    frames = list(frames_of(labels, numbers, frame))
    random.Random(1).shuffle(frames)

    meta = FileMetaDataset()
    meta.MediaStorageSOPClassUID = uid.SegmentationStorage
    meta.MediaStorageSOPInstanceUID = uid.generate_uid(entropy_srcs=["phrenic"])
    meta.TransferSyntaxUID = syntax
    file = FileDataset(sys.argv[2], {}, file_meta=meta, preamble=b"\0" * 128)
    file.is_little_endian = syntax != uid.ExplicitVRBigEndian
    file.is_implicit_VR = syntax == uid.ImplicitVRLittleEndian
    file.SOPClassUID = meta.MediaStorageSOPClassUID
    file.SOPInstanceUID = meta.MediaStorageSOPInstanceUID
    file.PatientName = "Doe^Jane"
    file.PatientID = "4711"
    file.Modality = "SEG"
    file.SegmentationType = "BINARY"
    file.SamplesPerPixel = 1
    file.PhotometricInterpretation = "MONOCHROME2"
    file.Columns, file.Rows = labels.shape[:2]
    file.NumberOfFrames = len(frames)
    file.BitsAllocated = file.BitsStored = 1
    file.HighBit = file.PixelRepresentation = 0
    file.SegmentSequence = Sequence([segment(n, names[label]) for n, label in enumerate(numbers, 1)])
    file.SharedFunctionalGroupsSequence = Sequence([shared_group(frame)])
    file.PerFrameFunctionalGroupsSequence = Sequence([frame_group(n, position) for n, position, _ in frames])
    bits = numpy.concatenate([pixels.ravel() for _, _, pixels in frames])
    packed = numpy.packbits(bits, bitorder="little").tobytes()
    file.PixelData = packed + b"\0" * (len(packed) % 2)
    file["PixelData"].VR = "OB"
    file.save_as(sys.argv[2], write_like_original=False)


main()
