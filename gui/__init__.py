"""The placement GUI: a Tkinter window that shows the object and its flat pieces and lets one move, add and edit sensors.

What belongs here: windows, canvases, key bindings and the undo list; every change is made to a
`skinfab.skin.Skin` by functions of `skinfab` and saved as a skin document. Geometry, checks and
G-code stay where they are: this package imports `skinfab` and `gcode`, and neither imports it.
"""
