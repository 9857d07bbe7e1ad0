"""The bundled SMACH runtime against recorded runs of SMACH itself."""
