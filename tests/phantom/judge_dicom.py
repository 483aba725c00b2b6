#!/usr/bin/python3
# judge_dicom.py SEG LABELS CT_SLICE CT SLICE: compares a DICOM Segmentation and a slice of a CT series, as pydicom reads
# them, with the NIfTI files of the same phase, as nibabel reads them: voxels, places, names, and codes as pydicom's
# dictionary of SNOMED CT has them. Prints "the same: ..." or an error.
import re
import sys

import nibabel
import numpy
import pydicom
from pydicom.sr._concepts_dict import concepts


def names_of(image):
    text = b"".join(extension.get_content() for extension in image.header.extensions).decode()
    return {int(key): name for key, name in re.findall(r'<Label Key="(\d+)"><!\[CDATA\[(.*?)\]\]>', text)}


def in_lps(image):
    return numpy.diag([-1, -1, 1, 1]) @ image.affine


def check_code(item):
    known = {value for names in concepts["SCT"].values() for value in names}
    code = item.SegmentedPropertyTypeCodeSequence[0]
    assert code.CodingSchemeDesignator == "SCT", item.SegmentLabel
    assert code.CodeMeaning != "Tissue", f"{item.SegmentLabel} has no code of its own"
    if code.CodeValue not in known:
        return False
    meaning = code.CodeMeaning.lower().replace(" ", "")
    same = [name.lower() for name, codes in concepts["SCT"].items() if code.CodeValue in codes]
    assert meaning in same, (code.CodeMeaning, same)
    return True


def main():
    seg, ct = pydicom.dcmread(sys.argv[1]), pydicom.dcmread(sys.argv[3])
    labels, numbers, k = nibabel.load(sys.argv[2]), nibabel.load(sys.argv[4]), int(sys.argv[5])
    frame = in_lps(labels)
    expected = numpy.asarray(labels.dataobj)
    names = names_of(labels)
    segments = {item.SegmentNumber: item.SegmentLabel for item in seg.SegmentSequence}
    known = sum(check_code(item) for item in seg.SegmentSequence)
    assert known > len(segments) / 4, "pydicom knows few of the codes"
    assert seg.PatientName == "" and seg.SegmentationType == "BINARY"

    bits = numpy.unpackbits(numpy.frombuffer(seg.PixelData, numpy.uint8), bitorder="little")
    frames = bits[: seg.NumberOfFrames * seg.Rows * seg.Columns].reshape(seg.NumberOfFrames, seg.Rows, seg.Columns)
    label_of = {name: label for label, name in names.items()}
    found = numpy.zeros_like(expected)
    for pixels, group in zip(frames, seg.PerFrameFunctionalGroupsSequence):
        at = [float(x) for x in group.PlanePositionSequence[0].ImagePositionPatient]
        i, j, slice_ = numpy.rint(numpy.linalg.inv(frame) @ [*at, 1])[:3].astype(int)
        assert (i, j) == (0, 0)
        name = segments[group.SegmentIdentificationSequence[0].ReferencedSegmentNumber]
        found[:, :, slice_][pixels.T == 1] = label_of[name]
    assert (found == expected).all(), f"{(found != expected).sum()} voxels differ"

    plane = numpy.asarray(numbers.dataobj)[:, :, k]
    assert (ct.pixel_array.T * ct.RescaleSlope + ct.RescaleIntercept == plane).all(), "CT numbers differ"
    assert numpy.allclose([float(x) for x in ct.ImagePositionPatient], (in_lps(numbers) @ [0, 0, k, 1])[:3], atol=1e-3)
    assert ct.FrameOfReferenceUID == seg.FrameOfReferenceUID and ct.StudyInstanceUID == seg.StudyInstanceUID
    print(f"the same: {len(segments)} segments, {(expected > 0).sum()} voxels, {known} codes known to pydicom")


main()
