# SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
# SPDX-License-Identifier: BSD-3-Clause
"""State files, Python state and traces give the same picture again, and the same values of all properties."""
from paraview import simple, smstate, smtrace

from penumbra_testing import SHADOWED, Checks, find_pass, load_plugin, output_path, picture

SIZE = [300, 200]

checks = Checks()


def build():
    """Every proxy of the plugin, with a value other than its default for every property."""
    floor = simple.Plane(registrationName="Floor", Origin=[-5, -5, 0], Point1=[5, -5, 0], Point2=[-5, 5, 0])
    receiver = simple.ShadowReceiver(registrationName="Receiver", Input=floor)
    change(
        receiver, TexelSize=0.07, Supersampling="2", LightSamples=100, SampleMultiplier=1.5,
        SamplingPattern="Correlated Multi-Jittered", Seed=5, Reflectance=[0.9, 0.8, 0.7],
        AmbientRadiance=[0.1, 0.05, 0.15], Side="Front", SolidAnglePerSample=0.001, ErrorTolerance=0.01,
        MaximumLightSamples=200, Reconstruction=0, ExactShares=0, PlanarityTolerance=0.02,
        ProxyPlane=1, ProxyPlaneMode="Given", ProxyOrigin=[0.0, 0.0, -0.1], ProxyNormal=[0.1, 0.0, 1.0], CastShadow=0)
    light = simple.AreaLight(registrationName="Lamp")
    change(
        light, Shape="Triangle", Origin=[1, -1, 6], Point1=[1, 1, 6], Point2=[3, -1, 6], Radiance=[8.0, 6.0, 9.0],
        TwoSided=1, AngularDiameter=3.0)
    sun = simple.AreaLight(registrationName="Sun")
    change(sun, Shape="Directional", Origin=[0, 0, 5], Point1=[1, 0, 0], AngularDiameter=4.0, Radiance=[0.2, 0.3, 0.4])
    window = make_window()
    sphere = simple.Sphere(registrationName="Ball", Center=[0, 0, 1.5], ThetaResolution=40, PhiResolution=40)
    caster = simple.ShadowCaster(registrationName="Caster", Input=sphere)
    change(caster, UseTransmittance=1, Transmittance=[0.2, 0.6, 0.4])
    hidden = simple.ShadowCaster(registrationName="Hidden", Input=sphere)
    change(hidden, CastShadow=0)
    simple.RadianceMap(registrationName="Map", Receivers=[receiver], Occluders=[caster, hidden], Lights=[light, sun, window])
    show(receiver, caster, light, sun, window)


def make_window():
    """A light from the cells of a plane, with a colour for each."""
    plane = simple.Plane(
        registrationName="Pane", Origin=[-1, -4, 1], Point1=[-1, -4, 3], Point2=[1, -4, 1], XResolution=2,
        YResolution=2)
    glass = simple.PythonCalculator(registrationName="Glass", Input=plane)
    change(
        glass, ArrayAssociation="Cell Data", ArrayName="glass",
        Expression="numpy.array([[9.0, 1, 1], [1, 9, 1], [1, 1, 9], [9, 9, 1]])")
    window = simple.AreaLightFromSurface(registrationName="Window", Input=glass)
    change(window, RadianceArray=["CELLS", "glass"], Radiance=[0.5, 0.6, 0.7], TwoSided=1)
    return window


def show(receiver, *others):
    view = simple.CreateView("RenderView")
    change(
        view, ViewSize=SIZE, CameraPosition=[8, -14, 8], CameraFocalPoint=[0, 0, 0.5], CameraViewUp=[0, 0, 1],
        OrientationAxesVisibility=0)
    display = simple.Show(receiver, view)
    change(display, Representation=SHADOWED, ShadowShading="Radiance")
    for source in others:
        simple.Show(source, view)


def change(proxy, **properties):
    """Sets properties as ParaView's panels do, which leave what they change in the trace."""
    tracing = simple.servermanager.vtkSMTrace.GetActiveTracer()
    item = smtrace.PropertiesModified(proxy) if tracing else None
    for name, value in properties.items():
        proxy.SetPropertyWithName(name, value)
    if item:
        item.finalize()


def values():
    """All values of all sources' properties, and those of the receiver's display that are the plugin's."""
    found = {}
    for (name, _), source in simple.GetSources().items():
        for key in source.ListProperties():
            found[name, key] = describe(source.GetPropertyValue(key))
    display = simple.GetDisplayProperties(simple.FindSource("Receiver"), the_view())
    for key in ("Representation", "ShadowShading"):
        found["display", key] = describe(display.GetPropertyValue(key))
    return found


def describe(value):
    """Numbers and texts as they are; inputs by their name."""
    proxy = getattr(value, "SMProxy", None)
    if proxy:
        return simple.servermanager.ProxyManager().GetProxyName("sources", proxy)
    if hasattr(value, "__len__") and not isinstance(value, str):
        return [describe(item) for item in value]
    return str(value)


def the_view():
    (view,) = simple.GetRenderViews()
    view.ViewSize = SIZE
    return view


def reset():
    simple.ResetSession()
    load_plugin()


def check_restored(name, wanted_values, wanted_picture):
    found = values()
    different = {key: (found.get(key), value) for key, value in wanted_values.items() if found.get(key) != value}
    checks.equal(different, {}, f"{name}: values that are not what they were, among {len(wanted_values)}")
    checks.check((picture(the_view()) == wanted_picture).all(), f"{name}: the picture is the same")
    checks.equal(find_pass(the_view()).GetNumberOfReceivers(), 1, f"{name}: receivers in the view")


def run(script):
    """Runs a script as pvpython does, but for its name."""
    exec(compile(script, "state.py", "exec"), {"__name__": "state"})


def check_states():
    build()
    wanted = values(), picture(the_view())
    path = output_path("TestState.pvsm")
    simple.SaveState(path)
    python = smstate.get_state()
    simple.Hide(simple.FindSource("Caster"), the_view())
    checks.check((picture(the_view()) != wanted[1]).any(), "without the ball, the picture is another one")

    reset()
    simple.LoadState(path)
    check_restored("state file", *wanted)

    reset()
    run(python)
    check_restored("Python state", *wanted)


def check_trace():
    reset()
    smtrace.start_trace()
    build()
    trace = smtrace.stop_trace()
    wanted = values(), picture(the_view())
    reset()
    run(trace)
    check_restored("trace", *wanted)


load_plugin()
check_states()
check_trace()
checks.finish()
