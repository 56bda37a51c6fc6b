"""Shows a result of clerestory solve: illuminance, lines of equal illuminance, a legend. Where there are rooms, what is
outdoors is left out, and one looks through the backs of walls into them.

In ParaView: Macros > Import new macro, once; then open a result, press Apply, and press the macro's button.
A result that was solved with --layers gets a calculator "Layers", which is the sum of them: write other factors than 1 into it and
press Apply, and colours and lines follow.
Without its window: pvpython clerestory_view.py RESULT.vtp PICTURE.png
"""
import sys

from paraview import servermanager, simple

SHOWN = "illuminance"


def levels_within(low, high, most=8):
    """1, 2 and 5 x 10^n between the two, the larger ones where there are too many."""
    levels = [step * 10.0**n for n in range(-3, 7) for step in (1, 2, 5)]
    return [level for level in levels if low < level < high][-most:]


def without_outdoors(source):
    """What is in rooms; all where there are none."""
    data = servermanager.Fetch(source)
    names = data.GetFieldData().GetAbstractArray("room_names")
    names = [names.GetValue(i) for i in range(names.GetNumberOfValues())] if names else []
    if "outdoors" not in names or len(names) < 2 or data.GetCellData().GetArray("room") is None:
        return source
    number = names.index("outdoors")
    return simple.Threshold(registrationName="Rooms", Input=source, Scalars=["CELLS", "room"],
                            LowerThreshold=number - 0.5, UpperThreshold=number + 0.5, Invert=1)


def with_factors(source):
    """The sum of the layers in place of all light; the source itself where it has none, or one that no formula can name."""
    layers = [array.Name for array in source.PointData if array.Name.startswith(SHOWN + ":")]
    if not layers or any('"' in layer for layer in layers):
        return source
    terms = ['1*"%s"' % layer for layer in layers]
    return simple.Calculator(registrationName="Layers", Input=source, AttributeType="Point Data", ResultArrayName=SHOWN,
                             Function=" + ".join(terms))


def show_result(source, view):
    source.UpdatePipeline()
    if source.PointData[SHOWN] is None:
        raise RuntimeError("there is no '%s' on the points: open a result of clerestory solve" % SHOWN)
    shown = without_outdoors(with_factors(source))
    shown.UpdatePipeline()
    low, high = shown.PointData[SHOWN].GetRange()

    simple.Hide(source, view)
    surfaces = simple.Show(shown, view)
    surfaces.SetRepresentationType("Surface")
    surfaces.BackfaceRepresentation = "Cull Backface"
    surfaces.Ambient, surfaces.Diffuse, surfaces.Specular = 1, 0, 0  # colours are those of the legend, without shading
    simple.ColorBy(surfaces, ("POINTS", SHOWN))
    table = simple.GetColorTransferFunction(SHOWN)
    table.ApplyPreset("Viridis (matplotlib)", True)
    table.RescaleTransferFunction(low, high)
    if low > 0 and high > 100 * low:
        table.MapControlPointsToLogSpace()
        table.UseLogScale = 1

    bar = simple.GetScalarBar(table, view)
    bar.Title, bar.ComponentTitle = SHOWN, "[lux]"
    bar.Visibility = 1

    lines = simple.Contour(registrationName="Isolux", Input=shown, ContourBy=["POINTS", SHOWN], Isosurfaces=levels_within(low, high))
    shown_lines = simple.Show(lines, view)
    shown_lines.ColorArrayName = ["POINTS", ""]
    shown_lines.AmbientColor = shown_lines.DiffuseColor = [0, 0, 0]
    shown_lines.Ambient, shown_lines.Diffuse = 1, 0
    shown_lines.LineWidth = 1.5
    view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = [-0.62, -0.83, 0.75], [0, 0, 0], [0, 0, 1]
    simple.ResetCamera(view)  # so far away that all is seen
    simple.SetActiveSource(source)
    simple.Render(view)


def main():
    files = [argument for argument in sys.argv[1:] if not argument.startswith("-")]
    if len(files) == 2:
        view = simple.CreateRenderView(ViewSize=[1200, 800])
        show_result(simple.OpenDataFile(files[0]), view)
        simple.SaveScreenshot(files[1], view)
        return
    source = simple.GetActiveSource()
    if source is None:
        raise RuntimeError("open a result of clerestory solve first, and press Apply")
    show_result(source, simple.GetActiveViewOrCreate("RenderView"))


if __name__ == "__main__":
    main()
