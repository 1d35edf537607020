"""Forms of cams: one module each, in the registry `base.FORMS`."""
