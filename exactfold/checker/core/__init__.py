"""What every kind of certificate needs: reading, exact numbers, linear algebra, Krawczyk's test."""
