#!/usr/bin/python3
# write_structures.py NIFTI DICOM LABEL...: draws contours around labels in each slice by matplotlib and writes them by
# pydicom as an RT Structure Set.
import re
import sys

import matplotlib

matplotlib.use("Agg")
import nibabel
import numpy
from matplotlib import pyplot
from pydicom import uid
from pydicom.dataset import Dataset, FileDataset, FileMetaDataset
from pydicom.sequence import Sequence


def names_of(image):
    text = b"".join(extension.get_content() for extension in image.header.extensions).decode()
    return {int(key): name for key, name in re.findall(r'<Label Key="(\d+)"><!\[CDATA\[(.*?)\]\]>', text)}


def contours_of(mask, frame):
    for k in numpy.flatnonzero(mask.any(axis=(0, 1))):
        padded = numpy.pad(mask[:, :, k].astype(float), 1)
        drawn = pyplot.contour(padded.T, levels=[0.5])
        for line in drawn.allsegs[0]:
            if len(line) < 4:
                continue
            points = numpy.c_[line[:-1] - 1, numpy.full(len(line) - 1, k), numpy.ones(len(line) - 1)] @ frame.T
            contour = Dataset()
            contour.ContourGeometricType = "CLOSED_PLANAR"
            contour.NumberOfContourPoints = len(points)
            contour.ContourData = [f"{x:.4f}" for x in points[:, :3].ravel()]
            yield contour
        pyplot.close()


def main():
    image = nibabel.load(sys.argv[1])
    labels, names = numpy.asarray(image.dataobj), names_of(image)
    frame = numpy.diag([-1, -1, 1, 1]) @ image.affine  # RAS to LPS
    meta = FileMetaDataset()
    meta.MediaStorageSOPClassUID = uid.RTStructureSetStorage
    meta.MediaStorageSOPInstanceUID = uid.generate_uid(entropy_srcs=["phrenic"])
    meta.TransferSyntaxUID = uid.ImplicitVRLittleEndian
    file = FileDataset(sys.argv[2], {}, file_meta=meta, preamble=b"\0" * 128)
    file.is_little_endian = file.is_implicit_VR = True
    file.SOPClassUID = meta.MediaStorageSOPClassUID
    file.SOPInstanceUID = meta.MediaStorageSOPInstanceUID
    file.Modality = "RTSTRUCT"
    file.PatientName = "Doe^Jane"
    file.StructureSetROISequence, file.ROIContourSequence = Sequence(), Sequence()
    for number, label in enumerate(map(int, sys.argv[3:]), 1):
        roi, drawn = Dataset(), Dataset()
        roi.ROINumber = drawn.ReferencedROINumber = number
        roi.ROIName = names[label]
        drawn.ContourSequence = Sequence(contours_of(labels == label, frame))
        file.StructureSetROISequence.append(roi)
        file.ROIContourSequence.append(drawn)
    file.save_as(sys.argv[2], write_like_original=False)


main()
