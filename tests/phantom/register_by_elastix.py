#!/usr/bin/python3
# register_by_elastix.py PHANTOM PHASE: registers phase 0 (fixed) of a folder that `phrenic phantom SCENE --ct --field
# --out PHANTOM` wrote to another phase (moving) by elastix (Debian: elastix, python3-nibabel) and prints how far its
# displacement is from the true one, by structure, beside that without registration. Exit code 77 without elastix.
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

import nibabel
import numpy

PARAMETERS = """
(FixedInternalImagePixelType "float") (MovingInternalImagePixelType "float") (UseDirectionCosines "true")
(Registration "MultiResolutionRegistration") (Metric "AdvancedMeanSquares") (Transform "BSplineTransform")
(FixedImagePyramid "FixedSmoothingImagePyramid") (MovingImagePyramid "MovingSmoothingImagePyramid")
(Interpolator "LinearInterpolator") (ResampleInterpolator "FinalBSplineInterpolator") (FinalBSplineInterpolationOrder 1) (Resampler "DefaultResampler")
(Optimizer "AdaptiveStochasticGradientDescent") (NumberOfResolutions 4) (MaximumNumberOfIterations 500)
(FinalGridSpacingInPhysicalUnits 16) (ImageSampler "RandomCoordinate") (NumberOfSpatialSamples 4000)
(NewSamplesEveryIteration "true") (CheckNumberOfSamples "false") (RequiredRatioOfValidSamples 0.05)
(AutomaticTransformInitialization "false") (HowToCombineTransforms "Compose") (DefaultPixelValue -1000)
(ErodeMask "false") (WriteResultImage "false") (ResultImageFormat "mhd") (FixedImageDimension 3) (MovingImageDimension 3)
"""


def registered(folder, phase):
    """The displacement that elastix finds at the voxels of phase 0 [mm, LPS]."""
    with tempfile.TemporaryDirectory() as work:
        parameters = pathlib.Path(work, "parameters.txt")
        parameters.write_text(PARAMETERS.replace(") (", ")\n("))
        fixed, moving = folder / "ct-00.nii.gz", folder / f"ct-{phase:02d}.nii.gz"
        run = {"check": True, "stdout": subprocess.DEVNULL}
        subprocess.run(["elastix", "-f", fixed, "-m", moving, "-p", parameters, "-out", work], **run)
        subprocess.run(["transformix", "-def", "all", "-tp", f"{work}/TransformParameters.0.txt", "-out", work], **run)
        return read_mhd(pathlib.Path(work, "deformationField.mhd"))


def read_mhd(path):
    header = dict(line.split(" = ", 1) for line in path.read_text().splitlines() if " = " in line)
    size = [int(n) for n in header["DimSize"].split()]
    kind = {"MET_FLOAT": "<f4", "MET_DOUBLE": "<f8"}[header["ElementType"]]
    numbers = numpy.fromfile(path.with_name(header["ElementDataFile"]), kind)
    return numbers.reshape(*size[::-1], 3).transpose(2, 1, 0, 3)


def main():
    folder, phase = pathlib.Path(sys.argv[1]), int(sys.argv[2])
    if not shutil.which("elastix"):
        print("elastix is not installed (Debian: elastix)")
        sys.exit(77)
    report = json.loads((folder / "report.json").read_text())
    labels = numpy.asarray(nibabel.load(folder / "labels-00.nii.gz").dataobj)
    truth = numpy.asarray(nibabel.load(folder / f"field-{phase:02d}.nii.gz").dataobj)[:, :, :, 0, :]
    found = registered(folder, phase)
    error = numpy.linalg.norm(found - truth, axis=-1)
    motion = numpy.linalg.norm(truth, axis=-1)
    print(f"{'structure':24} {'motion mm':>10} {'error mm':>10} {'95 % mm':>10}")
    for name, label in [("all", None), *report["labels"].items()]:
        inside = labels > 0 if label is None else labels == label
        if inside.sum() < 200:
            continue
        print(f"{name:24} {motion[inside].mean():10.2f} {error[inside].mean():10.2f} "
              f"{numpy.percentile(error[inside], 95):10.2f}")


main()
