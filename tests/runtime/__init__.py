"""The bundled SMACH runtime and traces."""
